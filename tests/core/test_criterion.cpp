// Criterion (42) and the relative residual against values worked out by hand.
#include "check.hpp"
#include "core/criterion.hpp"

#include <cmath>

using nscd::Body;
using nscd::Contact;

struct Hand {
  nscd::AlignedVector<Body> bodies;
  std::vector<Contact> contacts;
  std::vector<double> workspace;

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
    return nscd::measure({bodies, contacts, restitution, free_norm, workspace}, carried);
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
