// SPDX-License-Identifier: GPL-2.0-or-later
#include "parallel/team.hpp"

#include "parallel/ranks.hpp"

#include <pthread.h>
#include <sched.h>
#include <signal.h>

namespace nscd {

namespace {

constexpr int spins_with_a_core = 4000;   // about 50 us, some sweeps of the smallest problem that threads are used for

int cores()
{
  cpu_set_t set;
  return sched_getaffinity(0, sizeof set, &set) == 0 ? CPU_COUNT(&set) : int(std::thread::hardware_concurrency());
}

inline void pause()
{
#if defined(__x86_64__)
  __builtin_ia32_pause();
#endif
}

// Signals are for the program's own thread.
class BlockedSignals {
 public:
  BlockedSignals()
  {
    sigset_t all;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before_);
  }
  ~BlockedSignals() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }

 private:
  sigset_t before_;
};

}    // namespace

Team::Team(int threads) : spins_(threads <= cores() ? spins_with_a_core : 0)
{
  const BlockedSignals blocked;
  for (int t = 1; t < threads; ++t) others_.emplace_back([this, t] { serve(t); });
}

Team::~Team()
{
  start({});
  for (std::thread &other : others_) other.join();
}

void Team::start(const Task &task)
{
  task_ = task;
  busy_.store(int(others_.size()), std::memory_order_relaxed);
  round_.fetch_add(1, std::memory_order_release);
  round_.notify_all();
}

void Team::run(const Task &task)
{
  start(task);
  task.call(task.work, 0);
  for (int spins = 0; busy_.load(std::memory_order_acquire) > 0; ++spins) {
    if (spins < spins_) pause();
    else sched_yield();
  }
}

void Team::serve(int thread)
{
  for (unsigned seen = 0;; ++seen) {
    for (int spins = 0; round_.load(std::memory_order_acquire) == seen; ++spins) {
      if (spins < spins_) pause();
      else round_.wait(seen, std::memory_order_acquire);
    }
    const Task task = task_;
    if (!task.work) return;
    task.call(task.work, thread);
    busy_.fetch_sub(1, std::memory_order_release);
  }
}

std::string crowding(int threads, const Ranks *ranks)
{
  const int here = ranks ? ranks->on_this_machine() : 1, all = threads * here;
  if (threads == 1 || all <= cores()) return {};
  const std::string whose = here > 1 ? std::to_string(here) + " ranks with " : "";
  return whose + "threads " + std::to_string(threads) + " on " + std::to_string(cores()) +
         (cores() == 1 ? " core" : " cores") +
         ": they will wait for each other; take fewer, or let ranks have more cores (mpiexec -bind-to)";
}

}    // namespace nscd
