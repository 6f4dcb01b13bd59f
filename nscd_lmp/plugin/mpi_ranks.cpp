// SPDX-License-Identifier: GPL-2.0-or-later
#include "mpi_ranks.hpp"

#include <sched.h>

#include <algorithm>

namespace nscd {

namespace {

constexpr int parcel_tag = 0;
constexpr int letter_tags[] = {1, 2};   // in turn: a rank may be one delivery ahead of another, not two

struct Machine {
  int ranks, cores;   // cores that any of the ranks may use
};

Machine look_at_machine(MPI_Comm world)
{
  MPI_Comm comm;
  MPI_Comm_split_type(world, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &comm);
  Machine machine{};
  MPI_Comm_size(comm, &machine.ranks);
  cpu_set_t cores;
  if (sched_getaffinity(0, sizeof cores, &cores) != 0) CPU_ZERO(&cores);
  MPI_Allreduce(MPI_IN_PLACE, &cores, int(sizeof cores), MPI_BYTE, MPI_BOR, comm);
  machine.cores = CPU_COUNT(&cores);
  MPI_Comm_free(&comm);
  return machine;
}

// MPI that waits keeps its core. All ranks must know the same: they choose their calls by it.
bool are_crowded(const Machine &machine, MPI_Comm comm)
{
  int crowded = machine.cores > 0 && machine.ranks > machine.cores;
  MPI_Allreduce(MPI_IN_PLACE, &crowded, 1, MPI_INT, MPI_MAX, comm);
  return crowded;
}

}    // namespace

MpiRanks::MpiRanks(MPI_Comm world)
{
  MPI_Comm_dup(world, &comm_);
  MPI_Comm_rank(comm_, &rank_);
  MPI_Comm_size(comm_, &count_);
  const Machine machine = look_at_machine(comm_);
  on_this_machine_ = machine.ranks;
  crowded_ = are_crowded(machine, comm_);
}

MpiRanks::~MpiRanks()
{
  int finalized = 0;
  MPI_Finalized(&finalized);
  if (!finalized) MPI_Comm_free(&comm_);
}

void MpiRanks::wait(std::span<MPI_Request> requests)
{
  if (!crowded_) {
    MPI_Waitall(int(requests.size()), requests.data(), MPI_STATUSES_IGNORE);
    return;
  }
  for (int done = 0; !done;) {
    MPI_Testall(int(requests.size()), requests.data(), &done, MPI_STATUSES_IGNORE);
    if (!done) sched_yield();
  }
}

// MPI leaves open whether all ranks get the same bits, but every implementation at hand reduces along one tree.
void MpiRanks::reduce(std::span<double> numbers, MPI_Op operation)
{
  const int count = int(numbers.size());
  if (!crowded_) {
    MPI_Allreduce(MPI_IN_PLACE, numbers.data(), count, MPI_DOUBLE, operation, comm_);
    return;
  }
  MPI_Request request;
  MPI_Iallreduce(MPI_IN_PLACE, numbers.data(), count, MPI_DOUBLE, operation, comm_, &request);
  wait({&request, 1});
}

void MpiRanks::sum(std::span<double> numbers) { reduce(numbers, MPI_SUM); }

void MpiRanks::max(std::span<double> numbers) { reduce(numbers, MPI_MAX); }

void MpiRanks::exchange(std::span<const Parcel> out, std::span<const Parcel> in)
{
  requests_.resize(out.size() + in.size());
  MPI_Request *request = requests_.data();
  for (const Parcel &p : in)
    MPI_Irecv(p.numbers.data(), int(p.numbers.size()), MPI_DOUBLE, p.rank, parcel_tag, comm_, request++);
  for (const Parcel &p : out)
    MPI_Isend(p.numbers.data(), int(p.numbers.size()), MPI_DOUBLE, p.rank, parcel_tag, comm_, request++);
  wait(requests_);
}

// Nonblocking consensus (Hoefler, Siebert & Lumsdaine 2010): synchronous sends end once they are received, and when all
// of a rank's have ended it enters a barrier; when the barrier is through, nothing is under way any more. No rank needs
// to know who writes to it, and nothing grows with the number of ranks but the barrier's logarithm.
std::vector<Letter> MpiRanks::deliver(const std::vector<Letter> &out)
{
  const int tag = letter_tags[letters_tag_ ^= 1];
  std::vector<MPI_Request> sends(out.size());
  for (std::size_t k = 0; k < out.size(); ++k)
    MPI_Issend(out[k].numbers.data(), int(out[k].numbers.size()), MPI_DOUBLE, out[k].rank, tag, comm_, &sends[k]);
  std::vector<Letter> came;
  MPI_Request barrier = MPI_REQUEST_NULL;
  for (int done = 0, waiting = 0; !done;) {
    int there = 0;
    MPI_Message message;
    MPI_Status status;
    MPI_Improbe(MPI_ANY_SOURCE, tag, comm_, &there, &message, &status);
    if (there) {
      int length = 0;
      MPI_Get_count(&status, MPI_DOUBLE, &length);
      Letter letter{status.MPI_SOURCE, std::vector<double>(length)};
      MPI_Mrecv(letter.numbers.data(), length, MPI_DOUBLE, &message, MPI_STATUS_IGNORE);
      came.push_back(std::move(letter));
    }
    if (crowded_ && !there) sched_yield();
    if (waiting) {
      MPI_Test(&barrier, &done, MPI_STATUS_IGNORE);
    } else {
      MPI_Testall(int(sends.size()), sends.data(), &waiting, MPI_STATUSES_IGNORE);
      if (waiting) MPI_Ibarrier(comm_, &barrier);
    }
  }
  std::sort(came.begin(), came.end(), [](const Letter &a, const Letter &b) { return a.rank < b.rank; });
  return came;
}

}    // namespace nscd
