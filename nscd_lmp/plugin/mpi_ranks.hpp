// SPDX-License-Identifier: GPL-2.0-or-later
// The ranks of a LAMMPS run, by MPI.
#pragma once

#include "parallel/ranks.hpp"

#include <mpi.h>

namespace nscd {

class MpiRanks final : public Ranks {
 public:
  // Takes a copy of the communicator, so that no message is taken for one of LAMMPS'.
  explicit MpiRanks(MPI_Comm world);
  ~MpiRanks() override;
  MpiRanks(const MpiRanks &) = delete;
  MpiRanks &operator=(const MpiRanks &) = delete;

  int rank() const override { return rank_; }
  int count() const override { return count_; }
  int on_this_machine() const override { return on_this_machine_; }
  void sum(std::span<double> numbers) override;
  void max(std::span<double> numbers) override;
  void exchange(std::span<const Parcel> out, std::span<const Parcel> in) override;
  std::vector<Letter> deliver(const std::vector<Letter> &out) override;

 private:
  void wait(std::span<MPI_Request> requests);
  void reduce(std::span<double> numbers, MPI_Op operation);

  MPI_Comm comm_;
  int rank_, count_, on_this_machine_;
  int letters_tag_ = 0;
  bool crowded_;   // on some machine more ranks than cores: those that wait must let the others work
  std::vector<MPI_Request> requests_;
};

}    // namespace nscd
