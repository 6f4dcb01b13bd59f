// SPDX-License-Identifier: GPL-2.0-or-later
#include "parallel/halo.hpp"

#include "base/error.hpp"
#include "parallel/halo_move.hpp"

#include <algorithm>
#include <exception>

namespace nscd {

double Halo::sum(double value)
{
  sum(std::span(&value, 1));
  return value;
}

double Halo::max(double value)
{
  max(std::span(&value, 1));
  return value;
}

void Halo::sum(std::span<double> values)
{
  ++traffic_.reductions;
  ranks_.sum(values);
}

void Halo::max(std::span<double> values)
{
  ++traffic_.reductions;
  ranks_.max(values);
}

std::vector<Letter> Halo::deliver(const std::vector<Letter> &out)
{
  for (const Letter &letter : out) {
    ++traffic_.messages;
    traffic_.bytes += double(letter.numbers.size() * sizeof(double));
  }
  return ranks_.deliver(out);
}

void Halo::together(const std::function<void()> &local)
{
  std::exception_ptr failure;
  std::string words;
  try {
    local();
  } catch (const std::exception &thrown) {
    failure = std::current_exception();
    words = thrown.what();
  } catch (...) {
    failure = std::current_exception();
    words = "an unknown error";
  }
  // The first rank that failed speaks.
  const double first = max(failure ? ranks_.count() - ranks_.rank() : 0);
  if (first == 0) return;
  const bool speaks = ranks_.count() - ranks_.rank() == int(first);
  std::vector<double> letters(std::size_t(max(speaks ? double(words.size()) : 0)), 0.0);
  if (speaks) std::copy(words.begin(), words.end(), letters.begin());
  sum(letters);
  if (failure && speaks) std::rethrow_exception(failure);
  throw Error(std::string(letters.begin(), letters.end()));
}

bool Halo::spread(std::vector<char> &flags)
{
  double changed = 0;
  const auto pack = [&](int body, double *to) { *to = flags[body]; };
  const auto unpack = [&](int body, const double *from) {
    changed += *from > flags[body];
    flags[body] = *from > flags[body] ? char(*from) : flags[body];
  };
  move(&Peer::copies, &Peer::owned, 1, pack, unpack);
  move(&Peer::owned, &Peer::copies, 1, pack, unpack);
  return max(changed) > 0;
}

void Halo::set_masses(std::span<Body> bodies, std::span<Contact> contacts, bool split)
{
  if (split == split_) return;
  split_ = split;
  for (const Shared &shared : shared_) {
    bodies[shared.body][3] = split ? shared.inverse_mass / shared.share : shared.inverse_mass;
  }
  for (const std::uint32_t k : touching_) {
    if (k >= contacts.size()) continue;
    Contact &c = contacts[k];
    c.w_inverse = 1 / (bodies[c.i][3] + bodies[c.j][3]);
  }
}

void Halo::open(std::span<const Body> bodies, const Vec4 *spins)
{
  const std::size_t n = exchanged_.size();
  agreed_.resize(spins ? 2 * n : n);
  for (std::size_t e = 0; e < n; ++e) {
    agreed_[e] = bodies[exchanged_[e]];
    if (spins) agreed_[n + e] = spins[exchanged_[e]];
  }
}

void Halo::close(std::span<Body> bodies, Vec4 *spins)
{
  const std::size_t n = exchanged_.size();
  for (std::size_t e = 0; e < n; ++e) {
    const int b = exchanged_[e];
    const double weight = split_ ? share_of_[b] : 1;
    if (weight == 1) continue;
    bodies[b] = agreed_[e] + (bodies[b] - agreed_[e]) * weight;
    if (spins) spins[b] = agreed_[n + e] + (spins[b] - agreed_[n + e]) * weight;
  }
  const std::size_t width = spins ? 6 : 3;
  move(&Peer::shared_copies, &Peer::shared_owned, width,
       [&](int b, double *to) {
         const std::size_t e = place_[b];
         put(bodies[b] - agreed_[e], to);
         if (spins) put(spins[b] - agreed_[n + e], to + 3);
       },
       [&](int b, const double *from) {
         add(bodies[b], from);
         if (spins) add(spins[b], from + 3);
       });
  move(&Peer::shared_owned, &Peer::shared_copies, width,
       [&](int b, double *to) {
         put(bodies[b], to);
         if (spins) put(spins[b], to + 3);
       },
       [&](int b, const double *from) {
         take(bodies[b], from);
         if (spins) take(spins[b], from + 3);
       });
}

}    // namespace nscd
