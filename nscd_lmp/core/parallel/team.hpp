// SPDX-License-Identifier: GPL-2.0-or-later
// Threads of one rank that work on a solve together.
//
// They spin for a moment when they have nothing to do, since a sweep is short, and then sleep: outside of solves they
// take no core from others, LAMMPS' own threads among them.
#pragma once

#include <atomic>
#include <cstddef>
#include <string>
#include <thread>
#include <vector>

namespace nscd {

class Ranks;

constexpr int most_threads = 64;

class Team {
 public:
  // The caller is one of the threads.
  explicit Team(int threads);
  ~Team();
  Team(const Team &) = delete;
  Team &operator=(const Team &) = delete;

  int size() const { return int(others_.size()) + 1; }

  // work(t), t = 0 .. size() - 1, each on a thread of its own, the caller's being 0. It must not throw.
  template <class Work>
  void run(const Work &work)
  {
    run({&work, [](const void *of, int thread) { (*static_cast<const Work *>(of))(thread); }});
  }

 private:
  struct Task {
    const void *work = nullptr;   // null: go home
    void (*call)(const void *, int) = nullptr;
  };
  void run(const Task &task);
  void start(const Task &task);
  void serve(int thread);

  Task task_;
  const int spins_;   // before a thread lets others have its core
  alignas(64) std::atomic<unsigned> round_{0};
  alignas(64) std::atomic<int> busy_{0};
  std::vector<std::thread> others_;
};

// What to tell users if threads would wait for each other's cores; empty if they have one each.
std::string crowding(int threads, const Ranks *ranks);

}    // namespace nscd
