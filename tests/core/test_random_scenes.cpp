// Random crowded scenes for every law and solver: whatever comes, a step either keeps what it promises or
// refuses and leaves the arrays alone. Most of its worth is under sanitizers.
#include "check.hpp"
#include "scene.hpp"

#include <cmath>

using nscd::Step;

static double kinetic_energy(const Scene &s)
{
  double sum = 0;
  for (int i = 0; i < s.owned; ++i)
    for (int d = 0; d < 3; ++d) sum += 0.5 * s.mass[i] * s.v[3 * i + d] * s.v[3 * i + d];
  return sum;
}

static std::string random_keywords(Random &random, const nscd::SolverEntry &solver)
{
  const char *restitutions[] = {"0", "0.5", "1"};
  std::string words = " restitution " + std::string(restitutions[int(random(0, 3))]);
  words += random() < 0.5 ? " warmstart yes" : " warmstart no";
  if (random() < 0.3)
    words += " " + std::string(solver.parameter) + " " + std::to_string(solver.default_parameter * random(0.3, 2));
  return words + " unconverged ignore maxiter 200 solver " + std::string(solver.name);
}

// What holds after any step: finite arrays, no tension in a solved step, the energy that contacts took accounted for.
static void check_step(const Scene &scene, const Step &step, double energy_before, double dissipated_before)
{
  bool finite = true, pushes = true;
  for (const double value : scene.x) finite &= std::isfinite(value);
  for (const double value : scene.v) finite &= std::isfinite(value);
  for (const double value : scene.f) finite &= std::isfinite(value);
  for (const auto &c : step.state().contacts) pushes &= c.impulse >= -1e-7 * c.w_inverse * step.report().contacts;
  CHECK(finite);
  CHECK(pushes || !step.report().converged);
  CHECK(!step.report().converged || step.report().criterion.total() < step.settings().tol);
  const double taken = step.report().dissipated - dissipated_before;
  CHECK_NEAR(energy_before - kinetic_energy(scene), taken, 1e-12 * (energy_before + std::abs(taken)));
}

static void run_scene(std::uint64_t seed, const std::string &law, const nscd::SolverEntry &solver, int steps)
{
  Random random(seed);
  Scene scene = random_scene(random, 40, 1, 0.12, 5);
  if (random() < 0.5) scene.mask[7] = scene.mask[20] = 2;
  for (const int i : {7, 20})
    if (scene.mask[i] == 2) scene.v[3 * i] = scene.v[3 * i + 1] = scene.v[3 * i + 2] = 0;
  Step step(settings("law " + law + random_keywords(random, solver) + box_walls(1, 1)));
  const double dt = random(1e-4, 5e-3);
  for (int k = 0; k < steps; ++k) {
    const Scene before = scene;
    const double energy = kinetic_energy(scene), dissipated = step.report().dissipated;
    try {
      scene.f.assign(scene.f.size(), 0);
      scene.advance(step, dt);
    } catch (const nscd::Error &error) {
      // Law moreau lets grains overlap by dt v, and the smallest are a few dt v large.
      CHECK(std::string(error.what()).find("more than") != std::string::npos);
      CHECK(scene.x == before.x && scene.v == before.v);
      return;
    }
    check_step(scene, step, energy, dissipated);
  }
}

static void run_scenes(const std::string &law)
{
  std::uint64_t seed = 1;
  for (const auto &solver : nscd::solvers())
    for (int scene = 0; scene < 12; ++scene) run_scene(seed++, law, solver, 40);
}

TEST(random_scenes_hold_what_law_moreau_promises) { run_scenes("moreau"); }

TEST(random_scenes_hold_what_law_gap_promises) { run_scenes("gap"); }

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
  for (const char *law : {"law moreau", "law gap"}) {
    Random one(99), two(99);
    Scene on = random_scene(one, 40, 1, 0.12, 2), off = random_scene(two, 40, 1, 0.12, 2);
    off.newton = false;
    Step a(settings(law + walls + " tol 1e-11 maxiter 20000")), b(settings(law + walls + " tol 1e-11 maxiter 20000"));
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
