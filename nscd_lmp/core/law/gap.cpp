// law gap: contact at the level of the gap (Stewart & Trinkle 1996; Anitescu & Potra 1997; Anitescu 2006).
//
//   S   = { pairs within reach, gap(q_k) < dt (speed_i + speed_j), that free motion brings near (detection.cpp), and
//           others that the solution would drive into each other: they join and the step is solved on }
//   gap > 0:  v_n + gap/dt >= 0            no penetration at q_{k+1} = q_k + dt v_{k+1}
//   gap < 0:  v_n >= min(recovery |gap|/dt, cap)
//   each complementary to p >= 0
//
// Spheres and planes are convex, so the linearised gap is a lower bound: the step leaves no overlap but what
// the solver's tolerance and contacts that were not foreseen leave. The recovery gives that back slowly: `cap` is a
// tenth of what the smooth forces change of its two grains' velocities, so that no overlap is ever thrown apart, and
// what pulls at other grains plays no part. With friction a bed
// between walls can be wedged: it cannot give anything back, and asking for it makes impulses grow without end. So
// there an overlap of 3e-5 of the smaller radius is left as it is.
//
// Restitution: impacts are resolved ahead of the contacts, one after another (impacts.hpp). Contacts that rest, and
// contacts pressed without an impact, are inelastic.
//
// Position update. v_{k+1} is what the constraint is about, but dt v_{k+1} is only first order in free flight
// and loses energy in impacts. So every grain takes the midpoint displacement dt (v_k + v_{k+1}) / 2, exact in
// free flight and conserving energy through elastic impacts, unless that lets one of its contacts penetrate;
// then both grains of that contact take dt v_{k+1}, until all contacts are open. It ends: grains only change
// in one direction, and if all have changed the solver's own constraint holds.
//
// Fails: an impact starts from where the grain is, up to dt v before the surface.
#include "../drift_of.hpp"
#include "../law.hpp"
#include "../hot.hpp"

#include <algorithm>
#include <cstdint>

namespace nscd {

namespace {

constexpr double recovery_cap = 0.1;   // of the grains' smooth velocity change
constexpr double tolerated_overlap = 3e-5;   // of the smaller radius, with friction

NSCD_HOT void set_biases(State &s, std::size_t first)
{
  const double rate = 1 / s.dt, back = s.settings.recovery / s.dt;
  const double tolerated = s.friction.model == Model::frictionless ? 0.0 : tolerated_overlap;
  for (std::size_t k = first; k < s.contacts.size(); ++k) {
    const ContactInfo &info = s.infos[k];
    const double overlap = std::max(0.0, -info.gap - tolerated * info.radius);
    const double cap = recovery_cap * info.kick + tolerance(s, worth(info)) + sudden_approach(s, k);
    s.contacts[k].bias = (info.gap > 0 ? info.gap * rate : -std::min(overlap * back, cap)) + normal_drift(s, k);
  }
}

class Gap final : public Law {
 public:
  bool looks_ahead() const override { return true; }
  bool resolves_impacts(const Settings &settings) const override
  {
    return settings.restitution > 0 || settings.e_t > 0;
  }
  bool impacts(State &s, const SolvePart &solve) override { return resolve_impacts(s, solve); }
  void set_bias(State &s, std::size_t first) override { set_biases(s, first); }
  void displace(State &s) override;

 private:
  NSCD_INLINE double rate(const State &s, std::size_t k) const;
  NSCD_INLINE bool is_open(const State &s, std::size_t k, double rate) const;
  bool open_contact(const State &s, std::uint32_t k);
  void open_contacts(const State &s);

  AlignedVector<Vec4> mean_;      // per body: midpoint velocity, or v_{k+1} where that is needed
  std::vector<char> final_;      // per body: moves with v_{k+1}
  std::vector<std::uint32_t> suspects_;   // contacts that may be driven into overlap
};

// Rate at which the contact's gap changes as its bodies move now, m/s.
NSCD_INLINE double Gap::rate(const State &s, std::size_t k) const
{
  const Contact &c = s.contacts[k];
  return dot(c.normal, mean_[c.i] - mean_[c.j]) + normal_drift(s, k);
}

// Whether the contact is left with no more overlap than the solver's tolerance leaves anyway.
NSCD_INLINE bool Gap::is_open(const State &s, std::size_t k, double rate) const
{
  const ContactInfo &info = s.infos[k];
  return !(info.gap + s.dt * rate < -left_of_overlap(s, worth(info), info.radius));
}

// If the contact is driven into overlap, both grains are made to move with v_{k+1}, unless that is worse still.
// Returns whether that changed a grain.
bool Gap::open_contact(const State &s, std::uint32_t k)
{
  const Contact &c = s.contacts[k];
  if (final_[c.i] && final_[c.j]) return false;
  const double now = rate(s, k), solved = normal_velocity(c, s.bodies.data()) + normal_drift(s, k);
  if (is_open(s, k, now) || now >= solved) return false;
  for (const int b : {c.i, c.j}) {
    mean_[b] = s.bodies[b];
    final_[b] = 1;
  }
  return true;
}

// Opens contacts until none is driven into overlap. After the first pass only contacts between a grain that has
// changed and one that has not can fail. The suspects are collected without branches, which would be mispredicted.
NSCD_HOT void Gap::open_contacts(const State &s)
{
  const std::size_t n = s.contacts.size();
  resize_closely(suspects_, n);
  std::size_t count = 0;
  for (std::size_t k = 0; k < n; ++k) {
    fetch_bodies(s.contacts[std::min(k + fetch_ahead, n - 1)], mean_.data());
    suspects_[count] = std::uint32_t(k);
    count += !is_open(s, k, rate(s, k));
  }
  for (bool changed = true; changed;) {
    changed = false;
    for (std::size_t q = 0; q < count; ++q) changed |= open_contact(s, suspects_[q]);
    count = 0;
    for (std::size_t k = 0; k < n && changed; ++k) {
      suspects_[count] = std::uint32_t(k);
      count += final_[s.contacts[k].i] != final_[s.contacts[k].j];
    }
  }
}

void Gap::displace(State &s)
{
  const std::size_t bodies = s.bodies.size();
  mean_.resize(bodies);
  final_.assign(bodies, 0);
  for (std::size_t i = 0; i < bodies; ++i) {
    const Body &b = s.bodies[i];
    if (b[3] > 0) {
      mean_[i] = 0.5 * (start_velocity(s, int(i)) + Vec4{0, 0, 0, b[3]} + b);
    } else {
      mean_[i] = b;
      final_[i] = 1;
    }
  }
  open_contacts(s);
  while (s.halo && s.halo->spread(final_)) {
    for (int i = 0; i < s.moving(); ++i)
      if (final_[i]) mean_[i] = s.bodies[i];
    open_contacts(s);
  }
  for (int i = 0; i < s.moving(); ++i) {
    const Vec4 &w = mean_[i];
    s.displacement[i] = Vec4{w[0], w[1], w[2], 0} * (way(s, i) == Way::stands ? 0.0 : s.dt);
  }
}

}    // namespace

static const RegisterLaw gap({20, "gap", "gap", [] { return std::unique_ptr<Law>(new Gap); }});

}    // namespace nscd
