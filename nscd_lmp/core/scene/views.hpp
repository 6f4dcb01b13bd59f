// SPDX-License-Identifier: GPL-2.0-or-later
// The arrays that the core is handed each step. It owns none of them and knows nothing of where they come from.
#pragma once

#include <cstdint>
#include <limits>

namespace nscd {

// The cell whose periodic images atoms have.
struct Box {
  double edges[6] = {};      // m: a = (xx, 0, 0), b = (xy, yy, 0), c = (xz, yz, zz), in the order xx yy zz yz xz xy
  double low[3] = {};        // its corner
  bool periodic[3] = {};
  // How its edges change from here on, m/s, where that is known beforehand; otherwise it is measured.
  bool rate_known = false;
  double rate[6] = {};
  bool changes_now = false;  // with a known rate: at the end of this step too
};

// All atoms of one rank: indices 0..owned-1 are integrated here, owned..owned+ghosts-1 are images, periodic ones or of
// atoms that other ranks own.
// Units are any consistent set (LAMMPS `units si`: m, kg, s, N).
struct Grains {
  int owned = 0;
  int ghosts = 0;
  double *x = nullptr;             // (owned + ghosts, 3), in: q_k; out: q_{k+1} (owned only)
  double *v = nullptr;             // (owned, 3), in: v_k; out: v_{k+1}
  double *f = nullptr;             // (owned, 3), in: smooth forces; out: mean contact force of the step
  double *omega = nullptr;         // (owned, 3), in: w_k, rad/s; out: w_{k+1}. With friction only, null otherwise
  double *torque = nullptr;        // (owned, 3), in: smooth torques; out: mean contact torque. As omega
  const double *unread_torque = nullptr;   // (owned, 3), torques of a scene without friction, which turns no grain
  const double *radius = nullptr;  // (owned + ghosts)
  const double *mass = nullptr;    // (owned)
  const std::int32_t *tag = nullptr;   // (owned + ghosts), unique per grain; an image has its grain's
  const int *home = nullptr;       // (ghosts) rank that owns the grain; null on one rank
  const int *mask = nullptr;       // (owned + ghosts)
  const int *type = nullptr;       // (owned + ghosts) from 1; where materials differ by pair
  int group = 1;                   // an atom moves if mask & group; the others are obstacles of infinite mass
  int later = 0;                   // obstacles of these groups move later in the step, all others have already moved
  int earlier = 0;                 // obstacles of these groups have moved since images were sent: their images have not
  int held = 0;                    // and so are those with mask & held, whose velocities are set to 0
  bool watched = false;            // nothing else may move grains between two steps, unless Step::forget_places is told
  double force_to_acceleration = 1;  // LAMMPS' ftm2v
  double square_to_energy = 1;       // LAMMPS' mvv2e: mass times velocity squared in units of energy
  const Box *box = nullptr;          // null: it stands still

  bool moves(int i) const { return (mask[i] & group) && !(mask[i] & held); }
};

// Which atoms were among a rank's arrays when the neighbor list was built, beside its own. The defaults are safe.
struct Images {
  double distance = 0;                   // m from every owned atom: all within; 0: as far as pairs are listed
  bool boxed = false;                    // also all within the box below; where it is not slanted
  double lo[3] = {}, hi[3] = {};         // m
  bool periodic[3] = {true, true, true};   // along an axis
};

// Half neighbor list in LAMMPS' layout; the top three bits of a neighbor index are flags.
struct PairList {
  int count = 0;
  const int *atom = nullptr;             // (count) index of atom i
  const int *neighbors = nullptr;        // (count) how many
  const int *const *first = nullptr;     // (count) per entry: pointer to the neighbor indices
  bool cross_pairs_twice = false;        // newton off: a pair with an image is listed from both sides
  double reach = 0;                      // surface distance up to which all pairs were listed when it was built
  bool just_built = false;               // at the positions that this step starts from
  double cutoff = 0;                     // distance of centres up to which pairs were listed; 0: by `reach`
  int types = 0;                         // where that depends on the types of the two:
  const int *type = nullptr;             // (owned + ghosts) 0 to types - 1
  const double *cutoffs = nullptr;       // (types, types)
  // Surface distance of what is listed, whatever that says; of lists by radii.
  double beyond_radii = std::numeric_limits<double>::infinity();
  bool excludes = false;                 // pairs within it are left out on purpose
  Images images{};
};
constexpr int neighbor_index_mask = 0x1FFFFFFF;

}    // namespace nscd
