// SPDX-License-Identifier: GPL-2.0-or-later
// Random crowded scenes for every law and solver: whatever comes, a step either keeps what it promises or
// refuses and leaves the arrays alone. Most of its worth is under sanitizers.
#include "check.hpp"
#include "scene.hpp"
#include "scene/slides.hpp"

#include <cmath>

using nscd::Step;

// Of spheres, with that of their spins: those change only where there is friction.
static double kinetic_energy(const Scene &s)
{
  double sum = 0;
  for (int i = 0; i < s.owned; ++i)
    for (int d = 3 * i; d < 3 * i + 3; ++d)
      sum += 0.5 * s.mass[i] * (s.v[d] * s.v[d] + 0.4 * std::pow(s.radius[i] * s.omega[d], 2));
  return sum;
}

static std::string random_keywords(Random &random, const nscd::SolverEntry &solver)
{
  const char *restitutions[] = {"0", "0.5", "1"};
  std::string words = " restitution " + std::string(restitutions[int(random(0, 3))]);
  words += random() < 0.5 ? " warmstart yes" : " warmstart no";
  if (random() < 0.3 && !solver.parameter.empty())
    words += " " + std::string(solver.parameter) + " " + std::to_string(solver.default_parameter * random(0.3, 2));
  return words + " criterion paper tol 1e-7 unconverged ignore maxiter 200 solver " + std::string(solver.name);
}

static std::string random_friction(Random &random)
{
  const char *coefficients[] = {" friction 0.1", " friction 0.5", " friction 3", " stick"};
  const char *impacts[] = {"", " e_t 0.5", " e_t 1"};
  return coefficients[int(random(0, 4))] + std::string(impacts[int(random(0, 3))]);
}

static bool in_tangent_planes(const nscd::State &s)
{
  bool inside = true;
  for (std::size_t k = 0; k < s.table.contacts.size(); ++k) {
    const nscd::Contact &c = s.table.contacts[k];
    const nscd::Vec4 p = nscd::tangential_impulse(s, k);
    inside &= std::abs(nscd::dot(c.normal, p)) <= 1e-9 * (nscd::length(p) + std::abs(c.impulse));
  }
  return inside;
}

// Coulomb's cones, to what the tolerance leaves.
static bool in_cones(const Step &step)
{
  const nscd::State &s = step.state();
  bool inside = true;
  for (std::size_t k = 0; k < s.table.contacts.size(); ++k) {
    const int j = s.table.infos[k].atom_j;
    const double mu = j < 0 ? s.in.materials[s.in.materials.of_wall(-1 - j)].friction : s.in.settings.material.friction;
    const double slack = 1e-7 * s.table.contacts[k].w_inverse * double(s.table.contacts.size());
    const double tangential = nscd::length(nscd::tangential_impulse(s, k)), normal = s.table.contacts[k].impulse;
    inside &= tangential <= slack + (normal > -slack ? mu * (normal + slack) : 0);
  }
  return inside;
}

// The mean over the contacts of what (42) makes of velocities and normal impulses as they are left, without those of
// impacts. With friction (42) has more, which is not negative.
static double left_over(const nscd::State &s)
{
  double sum = 0;
  for (std::size_t k = 0; k < s.table.contacts.size(); ++k) {
    const nscd::Contact &c = s.table.contacts[k];
    const double v = nscd::normal_velocity(c, s.motion.bodies.data()) + c.bias;
    const double p = c.impulse - (s.table.impact_impulse.is_open() ? s.table.impact_impulse[k] : 0);
    sum += std::max(0.0, -v);
    if (s.friction.model == nscd::Model::frictionless) sum += std::abs(v * p);
  }
  return sum / std::max(1.0, double(s.table.contacts.size())) / (1 + s.in.settings.material.restitution);
}

// What holds after any step: finite arrays, no tension in a solved step, the energy that contacts took accounted for.
static void check_step(const Scene &scene, const Step &step, double energy, const nscd::StepReport &last)
{
  bool finite = true, pushes = true;
  for (const double value : scene.x) finite &= std::isfinite(value);
  for (const double value : scene.v) finite &= std::isfinite(value);
  for (const double value : scene.f) finite &= std::isfinite(value);
  for (const double value : scene.omega) finite &= std::isfinite(value);
  for (const double value : scene.torque) finite &= std::isfinite(value);
  for (const auto &c : step.state().table.contacts) pushes &= c.impulse >= -1e-7 * c.w_inverse * step.report().contacts;
  CHECK(finite);
  CHECK(pushes || !step.report().converged);
  CHECK(in_cones(step) || !step.report().converged);
  CHECK(in_tangent_planes(step.state()));
  // Limited impulses are blended, not solved for.
  const bool solved = step.report().converged && step.report().energy_limited == last.energy_limited;
  CHECK(!solved || left_over(step.state()) < *step.settings().tol);
  const double taken = step.report().dissipated - last.dissipated;
  CHECK_NEAR(energy - kinetic_energy(scene), taken, 1e-12 * (energy + std::abs(taken)));
}

static void run_scene(std::uint64_t seed, const std::string &law, const nscd::SolverEntry &solver, bool friction)
{
  Random random(seed);
  Scene scene = random_scene(random, 40, 1, 0.12, 5);
  std::string words = "law " + law + (friction ? random_friction(random) : "");
  if (friction)
    for (double &w : scene.omega) w = random(-50, 50);
  if (random() < 0.5) scene.mask[7] = scene.mask[20] = 2;
  for (const int i : {7, 20})
    for (int d = 3 * i; d < 3 * i + 3 && scene.mask[i] == 2; ++d) scene.v[d] = scene.omega[d] = 0;
  words += random_keywords(random, solver) + box_walls(1, 1);
  Step step(settings(words));
  const double dt = random(1e-4, 5e-3);
  for (int k = 0; k < 40; ++k) {
    const Scene before = scene;
    const double energy = kinetic_energy(scene);
    const nscd::StepReport last = step.report();
    try {
      scene.accelerate({});
      scene.advance(step, dt);
    } catch (const nscd::Error &error) {
      // Law moreau lets grains overlap by dt v, and the smallest are a few dt v large. Where a law diverges grains get
      // faster than any list can follow.
      const std::string message = error.what();
      const bool lost = message.find("contacts could be missed") != std::string::npos && !step.report().converged;
      CHECK(lost || message.find("more than") != std::string::npos);
      CHECK(scene.x == before.x && scene.v == before.v && scene.omega == before.omega);
      return;
    }
    check_step(scene, step, energy, last);
  }
}

static void run_scenes(const std::string &law, bool friction = false)
{
  std::uint64_t seed = 1;
  for (const auto &solver : friction ? nscd::frictional_solvers() : nscd::solvers())
    for (int scene = 0; scene < 12; ++scene) run_scene(seed++, law, solver, friction);
}

TEST(random_scenes_hold_what_law_moreau_promises) { run_scenes("moreau"); }

TEST(random_scenes_hold_what_law_gap_promises) { run_scenes("gap"); }

TEST(random_scenes_with_friction_hold_what_law_moreau_promises) { run_scenes("moreau", true); }

TEST(random_scenes_with_friction_hold_what_law_gap_promises) { run_scenes("gap", true); }

// Images of all grains within 0.3 of the box's x faces; the box is periodic in x, with walls in y and z.
static void refresh_images(Scene &scene)
{
  scene.x.resize(3 * std::size_t(scene.owned));
  scene.radius.resize(scene.owned);
  scene.tag.resize(scene.owned);
  for (int i = 0; i < scene.owned; ++i) {
    double &x = scene.x[3 * i];
    x -= std::floor(x);
    if (x < 0.3) scene.add_image(i, {1, 0, 0});
    if (x > 0.7) scene.add_image(i, {-1, 0, 0});
  }
  scene.list_all_pairs();
}

// Newton's third law for lists: whether LAMMPS lists a cross pair once or twice must not matter.
TEST(periodic_random_scenes_do_not_depend_on_newton)
{
  const std::string walls =
      " wall plane 0 0 0 0 1 0 wall plane 0 0 0 0 0 1 wall plane 0 1 0 0 -1 0 wall plane 0 0 1 0 0 -1";
  for (const char *law : {"law moreau", "law gap", "law moreau friction 0.5", "law gap friction 0.5"}) {
    Random one(99), two(99);
    Scene on = random_scene(one, 40, 1, 0.12, 2), off = random_scene(two, 40, 1, 0.12, 2);
    off.newton = false;
    const std::string words = law + walls + " criterion paper tol 1e-11 maxiter 20000";
    Step a(settings(words)), b(settings(words));
    for (int k = 0; k < 30; ++k) {
      for (Scene *scene : {&on, &off}) {
        scene->accelerate({0, 0, -10});
        refresh_images(*scene);
      }
      on.advance(a, 1e-3);
      off.advance(b, 1e-3);
      CHECK(a.report().contacts == b.report().contacts);
    }
    double difference = 0;
    for (std::size_t d = 0; d < on.v.size(); ++d) difference = std::max(difference, std::abs(on.v[d] - off.v[d]));
    CHECK(difference < 1e-7);  // the contacts are in another order; tol leaves 1e-11 a step, which collisions amplify
  }
}
