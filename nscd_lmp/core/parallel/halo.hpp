// SPDX-License-Identifier: GPL-2.0-or-later
// Grains that several ranks know: who has copies of whose, and how their contacts act together.
//
// A contact is solved by one rank, which has a copy of the other rank's grain: a body of its own, with an index behind
// those of the grains that it owns. A grain is shared if contacts of several ranks touch it. Within an iteration every
// rank works on its own copy; then the corrections are put together.
//
// Mass splitting: the ranks' sweeps do not see each other, and two full corrections of one grain overshoot. So while
// they sweep, a rank that has c_r of a grain's c contacts takes c_r / c of its mass (and moment of inertia), and the
// grain then moves with the mean of its copies' velocities, weighted by mass. This is a block Gauss-Seidel method for
// blockdiag(W_r) - W >= 0 (the mean is convex), so the iteration converges as on one rank, at any number of ranks; what
// is solved is the problem with the true masses. Source: Tonge, Benevolenski & Voroshilov (2012), who split masses for
// Jacobi's method; deviation: shares by the number of contacts.
//
// All functions but those marked local are collective.
#pragma once

#include "base/storage.hpp"
#include "contact/contact.hpp"
#include "parallel/ranks.hpp"

#include <cstdint>
#include <functional>
#include <span>
#include <utility>
#include <vector>

namespace nscd {

// The atoms of this rank, and of its images the ranks that own their grains.
struct Known {
  std::span<const std::int32_t> owned, images;   // tags
  std::span<const int> homes;                    // beside images
};

// What the halo has moved, for models of its cost.
struct Traffic {
  double exchanges = 0;     // rounds of messages between neighbours
  double messages = 0;      // sent by this rank
  double bytes = 0;         // sent by this rank
  double reductions = 0;    // over all ranks
};

class Halo {
 public:
  explicit Halo(Ranks &ranks) : ranks_(ranks) {}
  Halo(const Halo &) = delete;
  Halo &operator=(const Halo &) = delete;

  const Ranks &ranks() const { return ranks_; }
  const Traffic &traffic() const { return traffic_; }

  double sum(double value);
  double max(double value);
  void sum(std::span<double> values);
  void max(std::span<double> values);

  // Runs `local`; if it throws on any rank, throws on all: there what was thrown, elsewhere Error with its words.
  void together(const std::function<void()> &local);

  // Local. With a new list: gives the grains of other ranks that have images here bodies behind the owned ones, which
  // `owner` gets, beside the images. Returns how many there are.
  int find_copies(const Known &known, std::span<int> owner);
  // Then tells the ranks that own them. `own_tags`: sorted, tag and index of owned atoms.
  void announce_copies(std::span<const std::pair<std::int32_t, int>> own_tags);
  // To all copies from their owners: messages of `width` numbers a body, pack(body, out) and unpack(body, in) for one
  // body; halo_move.hpp.
  template <class Pack, class Unpack>
  void to_copies(std::size_t width, Pack pack, Unpack unpack);

  // With new contacts: which grains are shared, and in what proportions.
  void share_contacts(std::span<const Body> bodies, std::span<const Contact> contacts);
  // Local. Which contacts touch them, if contacts have changed places since.
  void find_touching(std::span<const Contact> contacts);
  // Copies' flags to their owners and back: set for all if it is for one. Returns whether that changed any, anywhere.
  bool spread(std::vector<char> &flags);

  // Local. Masses of shared grains, and what contacts know of them, for sweeps; and back.
  void split(std::span<Body> bodies, std::span<Contact> contacts) { set_masses(bodies, contacts, true); }
  void join(std::span<Body> bodies, std::span<Contact> contacts) { set_masses(bodies, contacts, false); }

  // What every rank's contacts did to shared grains between open and close, put together. `open` is local.
  void open(std::span<const Body> bodies, const Vec4 *spins);
  void close(std::span<Body> bodies, Vec4 *spins);

  // Local. Of the last plan: owner of an atom's grain, by tag; -1 for one that is not known here.
  int home_of(std::int32_t tag) const;
  // Local. Tags that this rank owns since the last plan but not before.
  const std::vector<std::int32_t> &arrivals() const { return arrivals_; }
  std::vector<Letter> deliver(const std::vector<Letter> &out);
  // Local. f(body) for every body here that contacts of another rank than its owner's touch, perhaps more than once.
  template <class F>
  void for_each_shared(F f) const
  {
    for (const Peer &peer : peers_)
      for (const Bodies &bodies : {std::cref(peer.shared_copies), std::cref(peer.shared_owned)})
        for (const std::int32_t body : bodies) f(body);
  }

 private:
  // What is exchanged with one other rank: bodies that it owns (copies here), and bodies of this rank (copies there).
  struct Peer {
    int rank;
    std::vector<std::int32_t> copies, owned;                  // body indices, in the same order on both sides
    std::vector<std::int32_t> shared_copies, shared_owned;    // those of them that contacts on the copy's rank touch
    std::vector<double> to, from;                             // buffers
  };
  struct Shared {
    std::int32_t body;
    double share;           // of its mass
    double inverse_mass;    // 1/kg, the true one
  };
  using Bodies = std::vector<std::int32_t>;

  void set_masses(std::span<Body> bodies, std::span<Contact> contacts, bool split);
  void find_shares(std::span<const Body> bodies, std::span<const Contact> contacts);
  void learn_tags(const Known &known);
  Peer &peer(int rank);

  // Messages of `width` numbers a body; pack(body, out) and unpack(body, in) for one body.
  template <class Pack, class Unpack>
  void move(Bodies Peer::*from, Bodies Peer::*to, std::size_t width, Pack pack, Unpack unpack);

  Ranks &ranks_;
  Traffic traffic_;
  std::vector<Peer> peers_;                  // by rank
  std::vector<Shared> shared_;               // bodies here that are not all of this rank's contacts
  std::vector<double> share_of_;             // (bodies) 1 where not shared
  std::vector<std::uint32_t> touching_;      // contacts that touch shared bodies
  AlignedVector<Vec4> agreed_;               // of `exchanged_` bodies when opened, then their spins
  std::vector<std::int32_t> exchanged_;      // bodies that corrections are exchanged of
  std::vector<std::int32_t> place_;          // (bodies) index in exchanged_
  std::vector<std::pair<std::int32_t, int>> homes_;   // tag, rank: of all that is known here; sorted
  std::vector<std::int32_t> tags_, arrivals_;   // of owned grains
  std::vector<std::int32_t> copied_;            // tags of copies, in the order of their bodies
  std::vector<Parcel> out_, in_;
  bool split_ = false;
};

// Runs `local`, on several ranks so that all fail if one does; `halo` null: on one.
template <class Local>
void together(Halo *halo, Local local)
{
  if (halo) halo->together(std::ref(local));
  else local();
}

}    // namespace nscd
