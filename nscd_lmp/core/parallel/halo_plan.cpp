// SPDX-License-Identifier: GPL-2.0-or-later
// Who has copies of whose grains, and which of them are shared.
#include "parallel/halo.hpp"

#include "base/error.hpp"
#include "parallel/halo_move.hpp"

#include <algorithm>

namespace nscd {

Halo::Peer &Halo::peer(int rank)
{
  auto at = std::lower_bound(peers_.begin(), peers_.end(), rank, [](const Peer &p, int r) { return p.rank < r; });
  if (at == peers_.end() || at->rank != rank) at = peers_.insert(at, Peer{rank, {}, {}, {}, {}, {}, {}});
  return *at;
}

void Halo::learn_tags(const Known &known)
{
  std::vector<std::int32_t> before = std::move(tags_);
  tags_.assign(known.owned.begin(), known.owned.end());
  std::sort(tags_.begin(), tags_.end());
  arrivals_.clear();
  std::set_difference(tags_.begin(), tags_.end(), before.begin(), before.end(), std::back_inserter(arrivals_));
  homes_.clear();
  for (const std::int32_t tag : tags_) homes_.push_back({tag, ranks_.rank()});
  for (std::size_t j = 0; j < known.images.size(); ++j)
    if (known.homes[j] != ranks_.rank()) homes_.push_back({known.images[j], known.homes[j]});
  std::sort(homes_.begin(), homes_.end());
  homes_.erase(std::unique(homes_.begin(), homes_.end()), homes_.end());
}

int Halo::home_of(std::int32_t tag) const
{
  const auto at = std::lower_bound(homes_.begin(), homes_.end(), std::pair<std::int32_t, int>{tag, -1});
  return at != homes_.end() && at->first == tag ? at->second : -1;
}

int Halo::find_copies(const Known &known, std::span<int> owner)
{
  learn_tags(known);
  peers_.clear();
  copied_.clear();
  std::vector<std::pair<int, std::int32_t>> remote;   // rank, tag: the order of copies
  for (const auto &[tag, rank] : homes_)
    if (rank != ranks_.rank()) remote.push_back({rank, tag});
  std::sort(remote.begin(), remote.end());
  const int first = int(known.owned.size());
  for (const auto &[rank, tag] : remote) {
    peer(rank).copies.push_back(first + int(copied_.size()));
    copied_.push_back(tag);
  }
  for (std::size_t j = 0; j < known.images.size(); ++j) {
    const int home = known.homes[j];
    if (home == ranks_.rank()) continue;
    const auto at = std::lower_bound(remote.begin(), remote.end(), std::pair{home, known.images[j]});
    owner[j] = first + int(at - remote.begin());
  }
  return int(remote.size());
}

void Halo::announce_copies(std::span<const std::pair<std::int32_t, int>> own_tags)
{
  std::vector<Letter> wanted;
  auto tag = copied_.begin();
  for (const Peer &p : peers_) {
    wanted.push_back({p.rank, {tag, tag + std::ptrdiff_t(p.copies.size())}});
    tag += std::ptrdiff_t(p.copies.size());
  }
  const std::vector<Letter> asked = deliver(wanted);
  together([&] {
    for (const Letter &letter : asked)
      for (const double number : letter.numbers) {
        const auto wanted_tag = std::int32_t(number);
        const auto at = std::lower_bound(own_tags.begin(), own_tags.end(), std::pair{wanted_tag, -1});
        if (at == own_tags.end() || at->first != wanted_tag)
          fail("rank ", letter.rank, " has an image of grain ", wanted_tag, " of rank ", ranks_.rank(),
               ", which does not have it");
        peer(letter.rank).owned.push_back(at->second);
      }
  });
}

// Contacts that touch a grain, here and on the other ranks, decide its shares.
void Halo::find_shares(std::span<const Body> bodies, std::span<const Contact> contacts)
{
  std::vector<double> here(bodies.size(), 0.0);
  for (const Contact &c : contacts)
    for (const int b : {c.i, c.j}) here[b] += bodies[b][3] > 0;
  std::vector<double> all = here;
  for (Peer &p : peers_) p.shared_copies = p.shared_owned = {};
  move(&Peer::copies, &Peer::owned, 1, [&](int b, double *to) { *to = here[b]; },
       [&](int b, const double *from) { all[b] += *from; });
  for (Peer &p : peers_) {
    for (const int b : p.copies)
      if (here[b] > 0) p.shared_copies.push_back(b);
    for (std::size_t k = 0; k < p.owned.size(); ++k)
      if (p.from[k] > 0) p.shared_owned.push_back(p.owned[k]);
  }
  move(&Peer::shared_owned, &Peer::shared_copies, 1, [&](int b, double *to) { *to = all[b]; },
       [&](int b, const double *from) { all[b] = *from; });
  share_of_.assign(bodies.size(), 1.0);
  shared_.clear();
  exchanged_.clear();
  place_.assign(bodies.size(), -1);
  const auto exchange = [&](int b) {
    if (place_[b] >= 0) return;
    place_[b] = int(exchanged_.size());
    exchanged_.push_back(b);
    if (here[b] == 0 || here[b] == all[b]) return;
    share_of_[b] = here[b] / all[b];
    shared_.push_back({b, share_of_[b], bodies[b][3]});
  };
  for (const Peer &p : peers_) {
    for (const int b : p.shared_owned) exchange(b);
    for (const int b : p.shared_copies) exchange(b);
  }
}

void Halo::find_touching(std::span<const Contact> contacts)
{
  touching_.clear();
  for (std::size_t k = 0; k < contacts.size(); ++k)
    if (share_of_[contacts[k].i] != 1 || share_of_[contacts[k].j] != 1) touching_.push_back(std::uint32_t(k));
}

void Halo::share_contacts(std::span<const Body> bodies, std::span<const Contact> contacts)
{
  find_shares(bodies, contacts);
  find_touching(contacts);
}

}    // namespace nscd
