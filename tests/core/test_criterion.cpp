// SPDX-License-Identifier: GPL-2.0-or-later
// Criterion (42) and the relative residual against values worked out by hand.
#include "check.hpp"
#include "problem/criterion.hpp"
#include "settings/settings.hpp"

#include <cmath>

using nscd::Body;
using nscd::Contact;

struct Hand {
  nscd::AlignedVector<Body> bodies;
  std::vector<Contact> contacts;
  nscd::Workspace workspace;

  // A grain of mass m that moves at `v` along its contact's normal against an obstacle.
  void add(double m, double v, double impulse, double bias = 0)
  {
    const int i = int(bodies.size());
    bodies.push_back(Body{0, 0, v, 1 / m});
    bodies.push_back(Body{});
    contacts.push_back({Body{0, 0, 1, 0}, bias, m, impulse, i, i + 1});
  }

  nscd::Criterion measure(double restitution = 0, double free_norm = 1, const double *carried = nullptr)
  {
    const nscd::Material material{0, restitution, 0};
    const std::vector<nscd::MaterialNumber> numbers(contacts.size(), 0);
    nscd::Problem problem{bodies, contacts, free_norm, workspace};
    problem.restitution = {numbers, {&material, 1}};
    return nscd::measure(problem, carried);
  }
};

TEST(no_contacts_have_no_residual)
{
  const nscd::Criterion c = Hand().measure(0, 0);
  CHECK(c.total() == 0 && c.relative == 0);
}

TEST(contacts_that_obey_the_law_have_no_residual)
{
  Hand scene;
  scene.add(2, 3, 0);     // separates, no impulse
  scene.add(2, 0, 5);     // rests, pushed
  scene.add(2, 0, 0);     // grazes
  scene.add(2, -1, 4, 1); // v + bias = 0, pushed
  const nscd::Criterion c = scene.measure();
  CHECK(c.total() == 0 && c.relative == 0);
}

// Contact 1: m = 2, v = -3, p = 5: |v p| = 15, penetration 3, natural map W (5 - max(0, 5 + 6)) = -3.
// Contact 2: m = 4, v = 2, p = 0.5: |v p| = 1, no penetration, natural map W (0.5 - max(0, 0.5 - 8)) = 1/8.
TEST(the_parts_have_their_values)
{
  Hand scene;
  scene.add(2, -3, 5);
  scene.add(4, 2, 0.5);
  const double carried[] = {-1, 5};  // |carried - v| = 2 and 3
  const nscd::Criterion c = scene.measure(0, 10, carried);
  CHECK_NEAR(c.motion, 2.5, 1e-15);
  CHECK_NEAR(c.bipotential, 8.0, 1e-15);
  CHECK_NEAR(c.penetration, 1.5, 1e-15);
  CHECK_NEAR(c.total(), 12.0, 1e-14);
  CHECK_NEAR(c.relative, std::sqrt(9 + 1.0 / 64) / 10, 1e-15);
}

// v~ = v / (1 + e) in (42); the relative residual is a ratio of velocities and does not change.
TEST(restitution_scales_the_parts)
{
  Hand scene;
  scene.add(2, -3, 5);
  const nscd::Criterion plain = scene.measure(0, 10), elastic = scene.measure(1, 10);
  CHECK_NEAR(elastic.bipotential, plain.bipotential / 2, 1e-15);
  CHECK_NEAR(elastic.penetration, plain.penetration / 2, 1e-15);
  CHECK_NEAR(elastic.relative, plain.relative, 1e-15);
}

// Each contact by its own: a collision of e 1 beside contacts of e 0.
TEST(restitution_scales_its_own_contact_alone)
{
  Hand scene;
  scene.add(2, -3, 5);
  scene.add(2, -1, 0);
  const nscd::Material materials[] = {{0, 0, 0}, {0, 1, 0}};
  const nscd::MaterialNumber numbers[] = {0, 1};
  nscd::Problem problem{scene.bodies, scene.contacts, 1, scene.workspace};
  problem.restitution = {numbers, materials};
  CHECK_NEAR(nscd::measure(problem).penetration, (3 + 0.5) / 2, 1e-15);
}

TEST(a_tensile_impulse_is_a_residual_though_its_contact_rests)
{
  Hand scene;
  scene.add(2, 0, -3);
  const nscd::Criterion c = scene.measure();
  CHECK_NEAR(c.bipotential, 1.5, 1e-15);  // W |p|
  CHECK_NEAR(c.relative, 1.5, 1e-15);
}

TEST(the_bias_counts_as_velocity)
{
  Hand scene;
  scene.add(2, -3, 0, 1);
  CHECK_NEAR(scene.measure().penetration, 2, 1e-15);
}

TEST(not_a_number_is_never_taken_for_converged)
{
  Hand scene;
  scene.add(2, NAN, 1);
  CHECK(!(scene.measure().total() < 1e-7));
}

// With friction: spheres of mass m, whose contacts slip in the plane z = 0 against obstacles, W_tt = 7/2 / m.
struct SlidingHand : Hand {
  nscd::AlignedVector<nscd::Vec4> spins;
  nscd::AlignedVector<nscd::Spatial::Slide> slides;
  double e_t = 0;

  // Slip and tangential impulse along a direction askew.
  void add(double m, double v, double slip, double mu, double impulse, double tangential, double bias = 0)
  {
    Hand::add(m, v, impulse);
    const nscd::Vec4 along{0.6, 0.8, 0, 0};
    bodies[bodies.size() - 2] += along * slip;
    spins.resize(bodies.size());
    slides.push_back({along * tangential, {0.6 * bias, 0.8 * bias, 0}, mu});
  }

  nscd::Criterion measure(double restitution = 0, double free_norm = 1, const double *carried = nullptr)
  {
    const nscd::Material material{0, restitution, e_t};
    const std::vector<nscd::MaterialNumber> numbers(contacts.size(), 0);
    nscd::Problem problem{bodies, contacts, free_norm, workspace};
    problem.restitution = {numbers, {&material, 1}};
    problem.sliding = {nscd::Model::spatial, nscd::sphere_spin_response, spins.data(), nullptr, slides.data()};
    return nscd::measure(problem, carried);
  }
};

TEST(contacts_that_obey_coulombs_law_have_no_residual)
{
  SlidingHand scene;
  scene.add(2, 0, 0, 0.5, 4, 1.5);              // sticks
  scene.add(2, 0, 0, 0.5, 4, -2);               // about to slip
  scene.add(2, 0, 3, 0.5, 4, -2);               // slips
  scene.add(2, 0, -1, 0.5, 4, -2, 4);           // slip and bias: 3
  scene.add(2, 0, 3, 0, 4, 0);                  // no friction
  scene.add(2, 1, 3, 0.5, 0, 0);                // separates
  scene.add(2, 0, 3, 0.5, 0, 0);                // grazes
  scene.add(2, 0, 0, nscd::stick, 4, 1e3);      // does not slip, whatever the impulse
  scene.add(2, 1, 3, nscd::stick, 0, 0);        // separates
  const nscd::Criterion c = scene.measure();
  CHECK_NEAR(c.total(), 0, 1e-14);
  CHECK_NEAR(c.relative, 0, 1e-14);
}

// m = 2, W_tt = 7/4. Slip 0.7 without friction force: bipotential mu p_n |u_t| = 1.4; the stick impulse 0.4 is within
// the disc of 2, so the law's residual is W_tt 0.4 = 0.7. Slip 7: 14, and the residual W_tt 2 = 3.5.
TEST(slip_without_its_impulse_is_a_residual)
{
  SlidingHand sticks, slips;
  sticks.add(2, 0, 0.7, 0.5, 4, 0);
  slips.add(2, 0, 7, 0.5, 4, 0);
  CHECK_NEAR(sticks.measure().bipotential, 1.4 + 0.7, 1e-14);
  CHECK_NEAR(sticks.measure(0, 10).relative, 0.07, 1e-15);
  CHECK_NEAR(slips.measure().bipotential, 14 + 3.5, 1e-13);
  CHECK_NEAR(slips.measure(0, 10).relative, 0.35, 1e-14);
}

// Its product of impulse and slip is 1e-10 J, far below any tolerance; W_tt 5e-11 = 1.75e-1 m/s is not.
TEST(slip_of_a_small_grain_is_seen)
{
  SlidingHand scene;
  scene.add(1e-9, 0, 1, 0.5, 1e-10, 0);
  CHECK_NEAR(scene.measure().bipotential, 0.175, 1e-9);
}

// p_t = 3 where mu p_n = 2, at rest: W_tt (3 - 2). Along the slip of 5 instead of against it: 5 for the law, 20 for the
// work.
TEST(impulses_out_of_the_cone_or_along_the_slip_are_residuals)
{
  SlidingHand outside, along, open;
  outside.add(2, 0, 0, 0.5, 4, 3);
  along.add(2, 0, 5, 0.5, 4, 2);
  open.add(2, 1, 0, 0.5, 0, 3);  // open, but friction acts
  CHECK_NEAR(outside.measure().bipotential, 1.75, 1e-14);
  CHECK_NEAR(along.measure().bipotential, 1.75 * 20 / 7 + 20, 1e-13);
  CHECK_NEAR(open.measure().bipotential, 1.75 * 3, 1e-14);
}

TEST(slip_under_stick_is_a_finite_residual)
{
  SlidingHand scene;
  scene.add(2, 0, 0.7, nscd::stick, 4, 1e6);
  CHECK_NEAR(scene.measure().bipotential, 0.7, 1e-9);
  CHECK_NEAR(scene.measure(0, 10).relative, 0.07, 1e-10);
  SlidingHand open;
  open.add(2, 1, 0.7, nscd::stick, 0, 0.4);
  CHECK_NEAR(open.measure().bipotential, 0.4 * 1.75, 1e-15);
}

// The normal part is scaled by 1/(1 + e), the slip by 1/(1 + e_t).
TEST(tangential_restitution_scales_the_slip)
{
  SlidingHand scene;
  scene.add(2, 0, 0.7, nscd::stick, 4, 0);
  scene.add(2, -3, 0, nscd::stick, 0, 0);
  scene.e_t = 0.25;
  const nscd::Criterion c = scene.measure(0.5);
  CHECK_NEAR(c.bipotential, 0.7 / 1.25 / 2, 1e-15);
  CHECK_NEAR(c.penetration, 3 / 1.5 / 2, 1e-15);
}

TEST(the_velocity_that_a_law_carries_counts_with_its_slip)
{
  SlidingHand scene;
  scene.add(2, 1, 0, 0.5, 0, 0);
  const double carried[] = {4, 0, 4, 0, 0};  // normal, tangential: off by 3 and 4
  CHECK_NEAR(scene.measure(0, 1, carried).motion, 5, 1e-15);
}

TEST(slip_that_is_not_a_number_is_never_taken_for_converged)
{
  SlidingHand scene;
  scene.add(2, 0, NAN, 0.5, 1, 0);
  CHECK(!(scene.measure().total() < 1e-7));
}
