// law gap: contact at the level of the gap (Stewart & Trinkle 1996; Anitescu & Potra 1997; Anitescu 2006).
//
//   S   = { pairs that can meet within the step: gap(q_k) < dt (speed_i + speed_j), and those farther apart that
//           the solution would drive into each other: they join and the step is solved on }
//   gap > 0:  v_n + gap/dt >= 0            no penetration at q_{k+1} = q_k + dt v_{k+1}
//   gap < 0:  v_n >= min(recovery |gap|/dt, cap)
//   each complementary to p >= 0
//
// Spheres and planes are convex, so the linearised gap is a lower bound: the step leaves no overlap but what
// the solver's tolerance and contacts that were not foreseen leave. The recovery gives that back slowly: `cap`
// is a tenth of the step's largest smooth velocity change, so that no overlap is ever thrown apart.
//
// Restitution. A contact that free motion would close in this step, faster than resting contacts do, is an
// impact: v_n >= -e v_n^k from the start of the step, whatever its gap. A contact that only the solution
// shows to be pressed (p > 0) although it was approaching becomes an impact too and the step is solved again.
//
// Position update. v_{k+1} is what the constraint is about, but dt v_{k+1} is only first order in free flight
// and loses energy in impacts. So every grain takes the midpoint displacement dt (v_k + v_{k+1}) / 2, exact in
// free flight and conserving energy through elastic impacts, unless that lets one of its contacts penetrate;
// then both grains of that contact take dt v_{k+1}, until all contacts are open. It ends: grains only change
// in one direction, and if all have changed the solver's own constraint holds.
//
// Fails: an impact starts from where the grain is, up to dt v before the surface; energy is lost where a
// chain of impacts runs through more than one contact in a step.
#include "../law.hpp"

#include <algorithm>
#include <cmath>

namespace nscd {

namespace {

constexpr double recovery_cap = 0.1;   // of the step's largest smooth velocity change
constexpr double resting_kicks = 2;    // slower than so many smooth velocity changes: resting, not an impact
constexpr double tolerances = 10;     // single contacts miss the mean criterion by about so much
constexpr int max_revisions = 8;

class Gap final : public Law {
 public:
  bool looks_ahead() const override { return true; }
  void set_bias(State &s, std::size_t first) override;
  bool revise(State &s) override;
  void displace(State &s) override;

 private:
  static double smooth_change(const State &s, const Contact &c);
  void make_impact(State &s, std::size_t k);
  bool separates(const State &s, std::size_t k);
  void open_contacts(const State &s);

  std::vector<char> impact_;     // per contact: it has the impact's bias
  std::vector<double> slow_;     // per contact: approach speed below which it is not an impact
  std::vector<Vec4> mean_;       // per body: midpoint velocity, or v_{k+1} where that is needed
  std::vector<char> final_;      // per body: moves with v_{k+1}
  std::vector<std::uint32_t> undecided_;   // contacts not both of whose bodies move with v_{k+1}
  double slack_ = 0;             // m, overlap that the solver's tolerance leaves anyway
  int revisions_ = 0;
};

// What the smooth forces of the step add to the contact's velocity, m/s.
double Gap::smooth_change(const State &s, const Contact &c)
{
  const auto kick = [&s](int body, int component) {
    if (body >= s.grains.owned) return 0.0;
    return s.grains.f[3 * std::size_t(body) + component] * s.bodies[body][3];
  };
  double rate = 0;
  for (int d = 0; d < 3; ++d) rate += c.normal[d] * (kick(c.i, d) - kick(c.j, d));
  return rate * s.dt * s.grains.force_to_acceleration;
}

void Gap::make_impact(State &s, std::size_t k)
{
  impact_[k] = 1;
  s.contacts[k].bias = std::min(s.contacts[k].bias, s.settings.restitution * s.infos[k].speed_before);
}

void Gap::set_bias(State &s, std::size_t first)
{
  const std::size_t n = s.contacts.size();
  const double rate = 1 / s.dt, back = s.settings.recovery / s.dt;
  const double cap = recovery_cap * s.smooth_kick + s.settings.tol;
  for (std::size_t k = first; k < n; ++k) {
    const double gap = s.infos[k].gap;
    s.contacts[k].bias = std::max(gap * (gap < 0 ? back : rate), -cap);
  }
  if (first == 0) revisions_ = 0;
  if (s.settings.restitution == 0) return;
  impact_.resize(first);
  impact_.resize(n, 0);
  slow_.resize(n);
  for (std::size_t k = first; k < n; ++k) {
    const double before = s.infos[k].speed_before;
    const double without = normal_velocity(s.contacts[k], s.bodies.data());
    slow_[k] = resting_kicks * std::abs(smooth_change(s, s.contacts[k])) + tolerances * s.settings.tol;
    const bool closes = s.infos[k].gap + s.dt * without < 0;
    if (closes && before < -slow_[k]) make_impact(s, k);
  }
}

bool Gap::revise(State &s)
{
  if (s.settings.restitution == 0 || revisions_ == max_revisions) return false;
  bool changed = false;
  for (std::size_t k = 0; k < s.contacts.size(); ++k) {
    if (impact_[k] || s.contacts[k].impulse <= 0 || s.infos[k].speed_before >= -slow_[k]) continue;
    make_impact(s, k);
    changed = true;
  }
  revisions_ += changed;
  return changed;
}

// Whether the contact stays open as its bodies move now; if not, both are made to move with v_{k+1}.
bool Gap::separates(const State &s, std::size_t k)
{
  const Contact &c = s.contacts[k];
  if (final_[c.i] && final_[c.j]) return true;
  const double rate = dot(c.normal, mean_[c.i] - mean_[c.j]);
  if (s.infos[k].gap + s.dt * rate >= -slack_ || rate >= normal_velocity(c, s.bodies.data())) return true;
  for (const int b : {c.i, c.j}) {
    mean_[b] = s.bodies[b];
    final_[b] = 1;
  }
  return false;
}

// Makes grains move with v_{k+1} until no contact is driven into overlap. After the first pass only contacts between
// a grain that has changed and one that has not can fail; those whose grains have both changed are done.
void Gap::open_contacts(const State &s)
{
  bool changed = false;
  undecided_.clear();
  for (std::size_t k = 0; k < s.contacts.size(); ++k) {
    changed |= !separates(s, k);
    if (!(final_[s.contacts[k].i] && final_[s.contacts[k].j])) undecided_.push_back(std::uint32_t(k));
  }
  while (changed) {
    changed = false;
    std::size_t kept = 0;
    for (const std::uint32_t k : undecided_) {
      const bool i = final_[s.contacts[k].i], j = final_[s.contacts[k].j];
      if (i != j) changed |= !separates(s, k);
      undecided_[kept] = k;
      kept += !(i && j);
    }
    undecided_.resize(kept);
  }
}

void Gap::displace(State &s)
{
  const std::size_t bodies = s.bodies.size();
  slack_ = tolerances * s.settings.tol * s.dt;
  mean_.resize(bodies);
  final_.assign(bodies, 0);
  for (std::size_t i = 0; i < bodies; ++i) {
    const Body &b = s.bodies[i];
    if (b[3] > 0) {
      const double *v = s.grains.v + 3 * i;
      mean_[i] = 0.5 * (Vec4{v[0], v[1], v[2], b[3]} + b);
    } else {
      mean_[i] = b;
      final_[i] = 1;
    }
  }
  open_contacts(s);
  for (int i = 0; i < s.grains.owned; ++i) {
    const Vec4 &w = mean_[i];
    s.displacement[i] = Vec4{w[0], w[1], w[2], 0} * (w[3] > 0 ? s.dt : 0.0);
  }
}

}    // namespace

static const RegisterLaw gap({20, "gap", "gap", [] { return std::unique_ptr<Law>(new Gap); }});

}    // namespace nscd
