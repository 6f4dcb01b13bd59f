// SPDX-License-Identifier: GPL-2.0-or-later
// What the core needs of the other ranks. The doors implement it; the core knows no MPI.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace nscd {

// Numbers for, or from, one other rank.
struct Parcel {
  int rank;
  std::span<double> numbers;
};

// The same with a content of its own.
struct Letter {
  int rank;
  std::vector<double> numbers;
};

class Ranks {
 public:
  virtual ~Ranks() = default;
  virtual int rank() const = 0;
  virtual int count() const = 0;
  virtual int on_this_machine() const = 0;   // this one included

  // Collective; in place, over all ranks; the same bits on every one.
  virtual void sum(std::span<double> numbers) = 0;
  virtual void max(std::span<double> numbers) = 0;

  // Between neighbours: every parcel of `out` has its counterpart, of the same length, in the receiver's `in`. At most
  // one parcel a rank in each.
  virtual void exchange(std::span<const Parcel> out, std::span<const Parcel> in) = 0;

  // Collective; letters to ranks that do not expect them. Returns those that came, by rank.
  virtual std::vector<Letter> deliver(const std::vector<Letter> &out) = 0;
};

}    // namespace nscd
