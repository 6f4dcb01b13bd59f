// SPDX-License-Identifier: GPL-2.0-or-later
// The messages of the halo: numbers of bodies, packed in the order that both sides have them in.
#pragma once

#include "parallel/halo.hpp"

namespace nscd {

inline void put(const Vec4 &v, double *to)
{
  for (int d = 0; d < 3; ++d) to[d] = v[d];
}

// The fourth component, a body's inverse mass, stays.
inline void take(Vec4 &v, const double *from) { v = Vec4{from[0], from[1], from[2], v[3]}; }
inline void add(Vec4 &v, const double *from) { v += Vec4{from[0], from[1], from[2], 0}; }

template <class Pack, class Unpack>
void Halo::move(Bodies Peer::*from, Bodies Peer::*to, std::size_t width, Pack pack, Unpack unpack)
{
  out_.clear();
  in_.clear();
  for (Peer &peer : peers_) {
    const Bodies &sent = peer.*from, &received = peer.*to;
    peer.to.resize(sent.size() * width);
    peer.from.resize(received.size() * width);
    for (std::size_t k = 0; k < sent.size(); ++k) pack(sent[k], &peer.to[k * width]);
    if (!peer.to.empty()) out_.push_back({peer.rank, peer.to});
    if (!peer.from.empty()) in_.push_back({peer.rank, peer.from});
    traffic_.messages += !peer.to.empty();
    traffic_.bytes += double(peer.to.size() * sizeof(double));
  }
  ++traffic_.exchanges;
  ranks_.exchange(out_, in_);
  for (const Peer &peer : peers_)
    for (std::size_t k = 0; k < (peer.*to).size(); ++k) unpack((peer.*to)[k], &peer.from[k * width]);
}

template <class Pack, class Unpack>
void Halo::to_copies(std::size_t width, Pack pack, Unpack unpack)
{
  move(&Peer::owned, &Peer::copies, width, pack, unpack);
}

}    // namespace nscd
