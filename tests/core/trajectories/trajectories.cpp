// SPDX-License-Identifier: GPL-2.0-or-later
// Prints, for scenes that meet most of what a step does, a hash of what all steps make of the grains (places,
// velocities, forces) and one of what they report. For changes that are to keep every bit: two builds on one machine
// must print the same. No test, since processors differ.
#include "scene.hpp"
#include "thread_ranks.hpp"

#include <cstdio>
#include <cstring>
#include <functional>

using nscd::Step;

static std::uint64_t hash(std::uint64_t before, const std::vector<double> &numbers)
{
  for (const double number : numbers) {
    std::uint64_t bits;
    std::memcpy(&bits, &number, sizeof bits);
    before = (before ^ bits) * 0x100000001b3;
    before ^= before >> 29;
  }
  return before;
}

struct Course {
  std::uint64_t grains = 0xcbf29ce484222325, told = grains;
  long contacts = 0, iterations = 0, unconverged = 0, limited = 0;
  void add(const Scene &scene, const nscd::StepReport &report)
  {
    for (const auto *numbers : {&scene.x, &scene.v, &scene.f, &scene.omega, &scene.torque})
      grains = hash(grains, *numbers);
    told = hash(told, {report.largest_overlap, report.dissipated, report.criterion.total()});
    contacts += report.contacts;
    iterations += report.iterations;
    unconverged = report.unconverged;
    limited = report.energy_limited;
  }
  void print(const char *name) const
  {
    std::printf("%-40s grains %016llx  report %016llx  contacts %ld, iterations %ld, unconverged %ld, limited %ld\n",
                name, static_cast<unsigned long long>(grains), static_cast<unsigned long long>(told), contacts,
                iterations, unconverged, limited);
  }
};

using EachStep = std::function<void(Scene &)>;

static void run(const char *name, Scene scene, const std::string &words, const Point &gravity, int dimension = 3,
                const EachStep &change = {}, int steps = 200)
{
  Step step(settings(words + " unconverged ignore"), {}, dimension);
  Course course;
  for (int k = 0; k < steps; ++k) {
    scene.accelerate(gravity);
    if (change) change(scene);
    const auto &report = scene.advance(step, 0.01);
    scene.just_built = false;
    course.add(scene, report);
  }
  course.print(name);
}

// Grains on a lattice of `side`, jittered, that fall onto each other.
static Scene bed(int side, int layers, bool flat = false)
{
  Random random(3);
  Scene scene;
  for (int i = 0; i < side * (flat ? 1 : side) * layers; ++i) {
    const double r = random(0.85, 0.98);
    const int x = i % side, y = flat ? i / side : i / side % side, z = flat ? 0 : i / (side * side);
    Point centre{2.0 * x + 1 + random(-1, 1) * (1 - r), 2.0 * y + 1, flat ? 0 : 2.0 * z + 1};
    if (!flat) centre[1] += random(-1, 1) * (1 - r);
    scene.add(centre, r, r * r * r, {random(-1, 1), random(-1, 1), flat ? 0 : random(-1, 1)});
  }
  return scene;
}

static void list_within(Scene &scene, double distance)
{
  std::vector<std::vector<int>> neighbors(scene.owned);
  for (int i = 0; i < scene.owned; ++i)
    for (int j = i + 1; j < scene.owned; ++j) {
      double d2 = 0;
      for (int d = 0; d < 3; ++d) d2 += std::pow(scene.x[3 * i + d] - scene.x[3 * j + d], 2);
      if (d2 < distance * distance) neighbors[i].push_back(j);
    }
  scene.list_pairs(neighbors);
}

// Half of a bed on each of two ranks, images of all others' grains.
static void run_on_two_ranks(const char *name, const std::string &words)
{
  const Scene all = bed(5, 6);
  std::vector<double> places = all.x;
  Course courses[2];
  on_ranks(2, [&](ThreadRanks &ranks) {
    const int rank = ranks.rank();
    const auto owner = [&](int i) { return all.x[3 * i] < 5 ? 0 : 1; };
    Scene scene = part_of_rank(all, rank, owner);
    std::vector<int> image_of;
    for (int i = 0; i < all.owned; ++i)
      if (owner(i) != rank) image_of.push_back(i);
    Step step(settings(words + " unconverged ignore" + box_walls(10, 14)), {}, 3, &ranks);
    double wait[1] = {};
    for (int k = 0; k < 40; ++k) {
      scene.accelerate({0, 0, -10});
      courses[rank].add(scene, scene.advance(step, 0.01));
      for (int i = 0; i < scene.owned; ++i)
        std::copy_n(&scene.x[3 * i], 3, &places[3 * (scene.tag[i] - 1)]);
      ranks.sum(wait);
      for (std::size_t g = 0; g < image_of.size(); ++g)
        std::copy_n(&places[3 * image_of[g]], 3, &scene.x[3 * (scene.owned + g)]);
      ranks.sum(wait);
    }
  });
  for (const Course &course : courses) course.print(name);
}

int main()
{
  const Point down{0, 0, -10}, down_flat{0, -10, 0};
  const std::string box = box_walls(10, 17);
  const std::string flat_box = " wall plane 0 0 0 1 0 0 wall plane 20 0 0 -1 0 0 wall plane 0 0 0 0 1 0";
  run("bed", bed(5, 8), "law gap" + box, down);
  run("bed, apgs", bed(5, 8), "law gap solver apgs" + box, down);
  run("friction", bed(5, 8), "law gap friction 0.5" + box, down);
  run("friction, given up", bed(5, 8), "law gap friction 0.5 maxiter 10" + box, down);
  run("discs", bed(10, 20, true), "law gap friction 0.5 restitution 0.3" + flat_box, down_flat, 2);
  run("impacts", bed(5, 8), "law gap restitution 0.5" + box, down);
  run("impacts with friction", bed(5, 8), "law gap friction 0.5 restitution 0.5 e_t 0.2" + box, down);
  run("impacts, given up", bed(5, 8), "law gap friction 0.5 restitution 0.9 maxiter 10" + box, down);
  run("moreau", bed(5, 8), "law moreau friction 0.5 restitution 0.5" + box, down);
  run("bounds on overlap", bed(5, 8), "law gap friction 0.3 overlap 1e-4" + box, down);
  run("growing grains", bed(5, 8), "law gap friction 0.3" + box, down, 3, [](Scene &scene) {
    for (double &radius : scene.radius) radius *= 1.0001;
  });
  Scene pressed = bed(5, 8);
  const int stamp = pressed.add_obstacle({5, 5, 21}, 4);
  pressed.v[3 * stamp + 2] = -4;
  run("stamp", pressed, "law gap friction 0.3 maxiter 60" + box_walls(10, 60), down, 3, [stamp](Scene &scene) {
    scene.x[3 * stamp + 2] += 0.01 * scene.v[3 * stamp + 2];
  });
  Scene large = bed(12, 12);   // whose contacts are worth two threads: fast grains have a long reach
  for (double &v : large.v) v *= 30;
  large.reach = 2.04;
  run("threads", large, "law gap friction 0.3 threads 2 maxiter 100" + box_walls(24, 30), down, 3, [](Scene &scene) {
    list_within(scene, 4);
    scene.just_built = true;
  }, 15);
  run_on_two_ranks("two ranks", "law gap friction 0.3 maxiter 60");
  run_on_two_ranks("two ranks, impacts", "law gap friction 0.3 restitution 0.5 maxiter 60");
}
