// SPDX-License-Identifier: GPL-2.0-or-later
// Ranks that are threads of one program: what the halo exchanges, without MPI.
#pragma once

#include "parallel/ranks.hpp"

#include <barrier>
#include <functional>
#include <memory>
#include <thread>
#include <vector>

class ThreadWorld {
 public:
  explicit ThreadWorld(int count) : count(count), all(count), numbers(count), parcels(count), letters(count) {}

  const int count;
  std::barrier<> all;
  std::vector<std::span<double>> numbers;                  // of each rank
  std::vector<std::span<const nscd::Parcel>> parcels;
  std::vector<const std::vector<nscd::Letter> *> letters;
};

class ThreadRanks final : public nscd::Ranks {
 public:
  ThreadRanks(ThreadWorld &world, int rank) : world_(world), rank_(rank) {}
  int rank() const override { return rank_; }
  int count() const override { return world_.count; }
  int on_this_machine() const override { return world_.count; }
  void sum(std::span<double> numbers) override
  {
    reduce(numbers, [](double a, double b) { return a + b; });
  }
  void max(std::span<double> numbers) override
  {
    reduce(numbers, [](double a, double b) { return a > b ? a : b; });
  }
  void exchange(std::span<const nscd::Parcel> out, std::span<const nscd::Parcel> in) override;
  std::vector<nscd::Letter> deliver(const std::vector<nscd::Letter> &out) override;

 private:
  template <class Operation>
  void reduce(std::span<double> numbers, Operation operation);

  ThreadWorld &world_;
  int rank_;
};

template <class Operation>
void ThreadRanks::reduce(std::span<double> numbers, Operation operation)
{
  world_.numbers[rank_] = numbers;
  world_.all.arrive_and_wait();
  std::vector<double> result(world_.numbers[0].begin(), world_.numbers[0].end());
  for (int r = 1; r < world_.count; ++r)
    for (std::size_t k = 0; k < result.size(); ++k) result[k] = operation(result[k], world_.numbers[r][k]);
  world_.all.arrive_and_wait();
  std::copy(result.begin(), result.end(), numbers.begin());
}

inline void ThreadRanks::exchange(std::span<const nscd::Parcel> out, std::span<const nscd::Parcel> in)
{
  world_.parcels[rank_] = out;
  world_.all.arrive_and_wait();
  for (const nscd::Parcel &mine : in)
    for (const nscd::Parcel &sent : world_.parcels[mine.rank])
      if (sent.rank == rank_) std::copy(sent.numbers.begin(), sent.numbers.end(), mine.numbers.begin());
  world_.all.arrive_and_wait();
}

inline std::vector<nscd::Letter> ThreadRanks::deliver(const std::vector<nscd::Letter> &out)
{
  world_.letters[rank_] = &out;
  world_.all.arrive_and_wait();
  std::vector<nscd::Letter> came;
  for (int r = 0; r < world_.count; ++r)
    for (const nscd::Letter &sent : *world_.letters[r])
      if (sent.rank == rank_) came.push_back({r, sent.numbers});
  world_.all.arrive_and_wait();
  return came;
}

// program(ranks) on each of `count` ranks.
inline void on_ranks(int count, const std::function<void(ThreadRanks &)> &program)
{
  ThreadWorld world(count);
  std::vector<std::thread> threads;
  for (int r = 0; r < count; ++r)
    threads.emplace_back([&world, &program, r] {
      ThreadRanks ranks(world, r);
      program(ranks);
    });
  for (std::thread &thread : threads) thread.join();
}
