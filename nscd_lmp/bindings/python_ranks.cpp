// SPDX-License-Identifier: GPL-2.0-or-later
#include "python_ranks.hpp"

#include <nanobind/ndarray.h>

namespace nb = nanobind;

namespace nscd {

namespace {

using Numbers = nb::ndarray<double, nb::numpy, nb::ndim<1>>;

// The numbers themselves, not a copy; Python must not keep them.
nb::object view(std::span<const double> numbers)
{
  static double none = 0;
  double *const data = numbers.empty() ? &none : const_cast<double *>(numbers.data());
  return nb::cast(Numbers(data, {numbers.size()}, nb::capsule(data, [](void *) noexcept {})),
                  nb::rv_policy::reference);
}

nb::list views(std::span<const Parcel> parcels)
{
  nb::list list;
  for (const Parcel &p : parcels) list.append(nb::make_tuple(p.rank, view(p.numbers)));
  return list;
}

}    // namespace

PythonRanks::PythonRanks(nb::object ranks) :
    ranks_(std::move(ranks)), rank_(nb::cast<int>(ranks_.attr("rank"))), count_(nb::cast<int>(ranks_.attr("count"))),
    on_this_machine_(nb::cast<int>(ranks_.attr("on_this_machine")))
{
}

void PythonRanks::sum(std::span<double> numbers)
{
  nb::gil_scoped_acquire gil;
  ranks_.attr("sum")(view(numbers));
}

void PythonRanks::max(std::span<double> numbers)
{
  nb::gil_scoped_acquire gil;
  ranks_.attr("max")(view(numbers));
}

void PythonRanks::exchange(std::span<const Parcel> out, std::span<const Parcel> in)
{
  nb::gil_scoped_acquire gil;
  ranks_.attr("exchange")(views(out), views(in));
}

std::vector<Letter> PythonRanks::deliver(const std::vector<Letter> &out)
{
  nb::gil_scoped_acquire gil;
  nb::list letters;
  for (const Letter &letter : out) letters.append(nb::make_tuple(letter.rank, view(letter.numbers)));
  std::vector<Letter> came;
  for (nb::handle one : ranks_.attr("deliver")(letters)) {
    const auto letter = nb::cast<nb::tuple>(one);
    const auto numbers = nb::cast<nb::ndarray<const double, nb::ndim<1>, nb::c_contig>>(letter[1]);
    came.push_back({nb::cast<int>(letter[0]), {numbers.data(), numbers.data() + numbers.shape(0)}});
  }
  return came;
}

}    // namespace nscd
