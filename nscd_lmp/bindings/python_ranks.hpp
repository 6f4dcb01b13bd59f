// SPDX-License-Identifier: GPL-2.0-or-later
// The ranks of a LAMMPS run, by a Python object: nscd_lmp.ranks.Ranks on mpi4py.
#pragma once

#include "parallel/ranks.hpp"

#include <nanobind/nanobind.h>

namespace nscd {

class PythonRanks final : public Ranks {
 public:
  // `ranks` has rank, count, on_this_machine, and the methods sum, max, exchange and deliver of Ranks, on float64
  // arrays.
  explicit PythonRanks(nanobind::object ranks);

  int rank() const override { return rank_; }
  int count() const override { return count_; }
  int on_this_machine() const override { return on_this_machine_; }
  void sum(std::span<double> numbers) override;
  void max(std::span<double> numbers) override;
  void exchange(std::span<const Parcel> out, std::span<const Parcel> in) override;
  std::vector<Letter> deliver(const std::vector<Letter> &out) override;

 private:
  nanobind::object ranks_;
  int rank_, count_, on_this_machine_;
};

}    // namespace nscd
