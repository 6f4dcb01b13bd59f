// Who has copies of whose grains, and which of them are shared.
#include "parallel/halo.hpp"

#include "base/error.hpp"
#include "parallel/halo_move.hpp"
#include "scene/spins.hpp"

#include <algorithm>

namespace nscd {

Halo::Peer &Halo::peer(int rank)
{
  auto at = std::lower_bound(peers_.begin(), peers_.end(), rank, [](const Peer &p, int r) { return p.rank < r; });
  if (at == peers_.end() || at->rank != rank) at = peers_.insert(at, Peer{rank, {}, {}, {}, {}, {}, {}});
  return *at;
}

void Halo::learn_tags(const State &s)
{
  const Grains &g = s.grains;
  std::vector<std::int32_t> before = std::move(tags_);
  tags_.assign(g.tag, g.tag + g.owned);
  std::sort(tags_.begin(), tags_.end());
  arrivals_.clear();
  std::set_difference(tags_.begin(), tags_.end(), before.begin(), before.end(), std::back_inserter(arrivals_));
  homes_.clear();
  for (const std::int32_t tag : tags_) homes_.push_back({tag, ranks_.rank()});
  for (int j = 0; j < g.ghosts; ++j)
    if (g.home[j] != ranks_.rank()) homes_.push_back({g.tag[g.owned + j], g.home[j]});
  std::sort(homes_.begin(), homes_.end());
  homes_.erase(std::unique(homes_.begin(), homes_.end()), homes_.end());
}

int Halo::home_of(std::int32_t tag) const
{
  const auto at = std::lower_bound(homes_.begin(), homes_.end(), std::pair<std::int32_t, int>{tag, -1});
  return at != homes_.end() && at->first == tag ? at->second : -1;
}

void Halo::plan(State &s)
{
  learn_tags(s);
  peers_.clear();
  std::vector<std::pair<int, std::int32_t>> remote;   // rank, tag: the order of copies
  for (const auto &[tag, rank] : homes_)
    if (rank != ranks_.rank()) remote.push_back({rank, tag});
  std::sort(remote.begin(), remote.end());
  s.copies.count = int(remote.size());
  std::vector<Letter> wanted;
  for (std::size_t c = 0; c < remote.size(); ++c) {
    const auto [rank, tag] = remote[c];
    if (wanted.empty() || wanted.back().rank != rank) wanted.push_back({rank, {}});
    wanted.back().numbers.push_back(tag);
    peer(rank).copies.push_back(s.grains.owned + int(c));
  }
  const Grains &g = s.grains;
  for (int j = g.owned; j < g.owned + g.ghosts; ++j) {
    const int home = g.home[j - g.owned];
    if (home == ranks_.rank()) continue;
    const auto at = std::lower_bound(remote.begin(), remote.end(), std::pair<int, std::int32_t>{home, g.tag[j]});
    s.owner[j] = g.owned + int(at - remote.begin());
  }
  const std::vector<Letter> asked = deliver(wanted);
  together([&] {
    for (const Letter &letter : asked)
      for (const double tag : letter.numbers) {
        const auto at = std::lower_bound(s.own_tags.begin(), s.own_tags.end(),
                                         std::pair<std::int32_t, int>{std::int32_t(tag), -1});
        if (at == s.own_tags.end() || at->first != std::int32_t(tag))
          fail("rank ", letter.rank, " has an image of grain ", std::int32_t(tag), " of rank ", ranks_.rank(),
               ", which does not have it");
        peer(letter.rank).owned.push_back(at->second);
      }
  });
}

void Halo::share_motion(State &s)
{
  const Friction &f = s.friction;
  const bool spins = f.model != Model::frictionless;
  Copies &copies = s.copies;
  copies.start.resize(copies.count);
  copies.kick.resize(copies.count);
  if (spins) {
    copies.start_spin.resize(copies.count);
    copies.spin_kick.resize(copies.count);
  }
  move(&Peer::owned, &Peer::copies, spins ? 13 : 7,
       [&](int body, double *to) {
         put(start_velocity(s, body), to);
         put(smooth_kick(s, body), to + 3);
         to[6] = s.bodies[body][3] - double(way(s, body));   // an obstacle has no inverse mass
         if (!spins) return;
         put(start_spin(s, body), to + 7);
         put(smooth_spin_kick(s, body), to + 10);
       },
       [&](int body, const double *from) {
         const int c = body - s.grains.owned;
         copies.start[c] = Vec4{from[0], from[1], from[2], 0};
         copies.kick[c] = Vec4{from[3], from[4], from[5], 0};
         s.bodies[body] = copies.start[c] + copies.kick[c] + Vec4{0, 0, 0, std::max(0.0, from[6])};
         if (from[6] < 0 && s.ways.empty()) s.ways.assign(s.moving(), Way::has_moved);
         if (from[6] < 0) s.ways[body] = Way(int(-from[6]));
         if (!spins) return;
         copies.start_spin[c] = Vec4{from[7], from[8], from[9], 0};
         copies.spin_kick[c] = Vec4{from[10], from[11], from[12], 0};
         s.friction.spins[body] = copies.start_spin[c] + copies.spin_kick[c];
       });
}

void Halo::share_places(State &s)
{
  s.copies.place.resize(s.copies.count);
  move(&Peer::owned, &Peer::copies, 3,
       [&](int body, double *to) { std::copy_n(s.grains.x + 3 * std::size_t(body), 3, to); },
       [&](int body, const double *from) {
         s.copies.place[body - s.grains.owned] = Vec4{from[0], from[1], from[2], 0};
       });
}

// Contacts that touch a grain, here and on the other ranks, decide its shares.
void Halo::find_shares(State &s)
{
  std::vector<double> here(s.bodies.size(), 0.0);
  for (const Contact &c : s.contacts)
    for (const int b : {c.i, c.j}) here[b] += s.bodies[b][3] > 0;
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
  share_of_.assign(s.bodies.size(), 1.0);
  shared_.clear();
  exchanged_.clear();
  place_.assign(s.bodies.size(), -1);
  const auto exchange = [&](int b) {
    if (place_[b] >= 0) return;
    place_[b] = int(exchanged_.size());
    exchanged_.push_back(b);
    if (here[b] == 0 || here[b] == all[b]) return;
    share_of_[b] = here[b] / all[b];
    shared_.push_back({b, share_of_[b], s.bodies[b][3]});
  };
  for (const Peer &p : peers_) {
    for (const int b : p.shared_owned) exchange(b);
    for (const int b : p.shared_copies) exchange(b);
  }
}

void Halo::find_touching(const State &s)
{
  touching_.clear();
  for (std::size_t k = 0; k < s.contacts.size(); ++k)
    if (share_of_[s.contacts[k].i] != 1 || share_of_[s.contacts[k].j] != 1) touching_.push_back(std::uint32_t(k));
}

void Halo::share_contacts(State &s)
{
  find_shares(s);
  find_touching(s);
}

}    // namespace nscd
