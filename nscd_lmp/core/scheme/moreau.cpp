// SPDX-License-Identifier: GPL-2.0-or-later
// law moreau: the paper's scheme (Barboteu & Dumont 2017, section 3; Moreau 1988; Jean 1999).
//
//   q_m     = q_k + (1 - theta) dt v_k                       (18), theta = 1/2
//   S       = { contacts with gap(q_m) <= 0 }
//   v~      = (v_n^{k+1} + e v_n^k) / (1 + e) >= 0,  p >= 0,  v~ p = 0        (21), (22)
//   u~_t    = (u_t^{k+1} + e_t u_t^k) / (1 + e_t)  and p_t obey Coulomb's law        with friction
//   q_{k+1} = q_m + theta dt v_{k+1}
//
// Makes exact: with theta = 1/2 the free flight, and with e = 1 also the energy, to round-off.
// Fails: contacts are seen only once they overlap. The overlap is O(dt v) and never given back. In free flight
// theta < 1/2 gains energy and theta > 1/2 loses it, (theta - 1/2) m g^2 dt^2 a step. A grain that a force f presses
// on something round is pushed on, since the normal is that at q_m and the force that at q_k: its angular momentum
// grows as exp((1 - theta) dt f t / (m r)), r being the radius of its path.
#include "scene/drift/drift_of.hpp"
#include "scheme/scheme.hpp"

namespace nscd {

namespace {

class Moreau final : public Scheme {
 public:
  explicit Moreau(const Settings &s) : Scheme({.prediction = 1 - s.theta, .restitution = s.restitutive()}) {}

  void set_bias(State &s, std::size_t first) override
  {
    if (!constants.restitution && s.drift.of.empty()) return;
    for (std::size_t k = first; k < s.table.contacts.size(); ++k) {
      const double e = constants.restitution ? s.material(k).restitution : 0;
      s.table.contacts[k].bias = e * s.table.infos[k].speed_before + normal_drift(s, k);
    }
  }

  bool displace(State &s, std::span<const char>) override
  {
    const double step = s.in.settings.theta * s.in.dt;
    for (int i = 0; i < s.moving(); ++i) {
      const Body &b = s.motion.bodies[i];
      s.motion.displacement[i] = Vec4{b[0], b[1], b[2], 0} * (way(s.motion, i) == Way::stands ? 0.0 : step);
    }
    return false;
  }
};

}    // namespace

static const RegisterScheme moreau({.order = 10,
                                    .name = "moreau",
                                    .title = "Moreau-Jean",
                                    .looks_ahead = false,
                                    .make = [](const Settings &s) { return std::unique_ptr<Scheme>(new Moreau(s)); }});

}    // namespace nscd
