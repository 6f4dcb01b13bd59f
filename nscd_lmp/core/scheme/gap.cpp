// SPDX-License-Identifier: GPL-2.0-or-later
// law gap: contact at the level of the gap (Stewart & Trinkle 1996; Anitescu & Potra 1997; Anitescu 2006).
//
//   S   = { pairs within reach, gap(q_k) < dt (speed_i + speed_j), that free motion brings near (detection.cpp), and
//           others that the solution would drive into each other: they join and the step is solved on }
//   gap > 0:  v_n + plane/dt >= 0          no penetration at q_{k+1} = q_k + dt v_{k+1}
//   gap < 0:  v_n >= min(recovery |gap|/dt, cap)
//   each complementary to p >= 0
//
// A contact that lasts takes its plane half-way through the step, where its impulse acts (moment.hpp). Spheres and
// planes are convex, so any plane is a lower bound: the step leaves no overlap but what planes nearer than the surface
// (left_by_planes), the solver's tolerance and contacts that were not foreseen leave. The recovery gives that back
// slowly: `cap` is a tenth of what the smooth forces change of its two grains' velocities, so that no overlap is ever
// thrown apart, and what pulls at other grains plays no part. With friction a bed between walls can be wedged: it
// cannot give anything back, and asking for it makes impulses grow without end. So there an overlap of 3e-5 of the
// smaller radius is left as it is.
//
// Restitution: impacts are resolved ahead of the contacts, one after another (impacts.hpp). Contacts that rest, and
// contacts pressed without an impact, are inelastic.
//
// Fails: an inelastic impact starts from where the grain is, up to dt v before the surface.
#include "base/hot.hpp"
#include "scene/contact_plane.hpp"
#include "scene/drift/drift_of.hpp"
#include "scheme/displacements.hpp"
#include "scheme/scheme.hpp"

#include <algorithm>
#include <cstdint>

namespace nscd {

namespace {

constexpr double recovery_cap = 0.1;   // of the grains' smooth velocity change
constexpr double tolerated_overlap = 3e-5;   // of the smaller radius, with friction

NSCD_HOT void set_biases(State &s, std::size_t first)
{
  const double rate = 1 / s.in.dt, back = s.in.settings.recovery / s.in.dt;
  const double tolerated = s.friction.model == Model::frictionless ? 0.0 : tolerated_overlap;
  for (std::size_t k = first; k < s.table.contacts.size(); ++k) {
    const ContactInfo &info = s.table.infos[k];
    const double overlap = std::max(0.0, -info.gap - tolerated * info.radius);
    const double cap = recovery_cap * info.kick + tolerance(s.scales, worth(info)) + sudden_approach(s, k);
    const double plane = open_gap(s, k);
    s.table.contacts[k].bias =
        (info.gap > 0 ? plane * rate : (plane - info.gap) * rate - std::min(overlap * back, cap)) + normal_drift(s, k);
  }
}

class Gap final : public Scheme {
 public:
  explicit Gap(const Settings &s) : Scheme({.moment = 0.5, .impacts_first = s.restitutive()}) {}
  bool impacts(State &s, const SolvePart &solve) override { return resolve_impacts(s, bends_, solve); }
  void set_bias(State &s, std::size_t first) override { set_biases(s, first); }
  bool displace(State &s, std::span<const char> jammed) override { return displacements_.fill(s, jammed); }

 private:
  Displacements displacements_;
  Bends bends_;
};

}    // namespace

static const RegisterScheme gap({.order = 20,
                                 .name = "gap",
                                 .title = "gap",
                                 .looks_ahead = true,
                                 .make = [](const Settings &s) { return std::unique_ptr<Scheme>(new Gap(s)); }});

}    // namespace nscd
