// SPDX-License-Identifier: GPL-2.0-or-later
// Pairs that can meet although the neighbor list lacks them, found among all atoms of this rank.
//
// A pair that is not listed was farther apart than the list's cutoff when it was built. Most steps need not look for
// such pairs: no grain has gone so far (Reach). Otherwise each pair is judged by its own approach.
//
// A pair of a grain and an image is found by the faster of the two, on the rank that owns it. So images have to reach
// as far as a grain can meet slower ones. Where they end, those are not known, but how grains move that are as near is
// (Profile).
//
// Two spheres that move straight meet only if gap + n.(d_i - d_j) <= 0, n their normal: their distance is convex.
#pragma once

#include "scene/list/cell_grid.hpp"
#include "scene/list/list_guard.hpp"
#include "scene/list/motion.hpp"
#include "scene/list/spread.hpp"

#include <optional>
#include <vector>

namespace nscd {

// A pair that is not listed, and meets.
struct Missed {
  Candidate pair;
  double gap;         // m, from where the motion starts
  double approach;    // m, of the motion
  double listed;      // m, distance of centres when the list was built
};

// A grain that can meet one of which no image is here.
struct Beyond {
  int atom;
  double distance;    // m, up to which there would have to be images
};

class MissedPairs {
 public:
  explicit MissedPairs(const ListGuard &list) : list_(list) {}

  // The list of the step, which must outlive it; `listed`: surface distance up to which it has all pairs. Local.
  void begin(const PairList &pairs, double listed);
  // AtomMotion to be judged.
  AtomMotion &motion() { return motion_; }
  // Whether displacements differ by so much that there can be pairs that meet, or come within `margin` (m) of that.
  // Collective.
  bool may_find(const State &state, double margin);
  // Finds them. Collective; returns whether there is any, anywhere.
  bool find(const State &state, double margin);

  const std::vector<Missed> &pairs() const { return missed_; }
  const std::optional<Beyond> &beyond() const { return beyond_; }
  // Centre distance up to which pairs of these atoms were listed, m.
  double cutoff(const State &state, int a, int b) const;
  // Of images, m from each owned atom at least.
  double images() const;
  double largest_radius() const { return largest_radius_; }
  bool excludes() const { return range_.excludes; }

 private:
  Bounds since_listed(int atom) const;
  Bounds displacements(const State &state, int atom) const;
  double spread(const State &state);
  void measure_paces(const State &state);
  bool is_ours(const State &state, int i, int j) const;
  double spread_by_layers(const State &state, double spread);
  bool has_profile() const { return range_.images.boxed; }
  void examine(const State &state, int a, int b, double margin);
  void search(const State &state, double margin);
  int look_at_pairs(const State &state, double margin);
  Bounds partners(const State &state, int atom, double margin) const;
  bool all_known(int atom, const Bounds &partners) const;
  std::optional<Beyond> farthest_beyond(const State &state, double margin) const;

  const ListGuard &list_;
  PairList range_;
  double listed_ = 0, largest_radius_ = 0;
  AtomMotion motion_;
  Bounds since_;                     // of displacements since the list was built
  Bounds moving_, all_;              // with those of the motion, of moving grains and of all
  alignas(vec4_alignment) Vec4 frame_{};   // mean displacement of the motion, m
  std::vector<double> pace_;      // (bodies) how far the motion gets in that frame, m
  Profile profile_;
  CellGrid grid_;
  AlignedVector<Vec4> sized_;     // (atoms) places, and how far grains and their motion get from there, m
  std::vector<Missed> missed_;
  std::optional<Beyond> beyond_;
};

}    // namespace nscd
