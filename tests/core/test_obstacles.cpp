// SPDX-License-Identifier: GPL-2.0-or-later
// Walls that no user has: what a kind of wall may be is more than a plane. Each is a class of this file, registered as
// planes are: a shell round the grains, which curves towards them and spins; a groove, which touches a grain in two
// places; a piston, which moves.
#include "check.hpp"
#include "obstacle/kinds.hpp"
#include "scene.hpp"
#include "scene/gap.hpp"
#include "scene/slides.hpp"
#include "step/report.hpp"
#include "stl_files.hpp"
#include "thread_ranks.hpp"

#include <cmath>
#include <filesystem>
#include <sstream>

using nscd::Arguments;
using nscd::BoxEdges;
using nscd::Obstacle;
using nscd::Step;
using nscd::Touch;
using nscd::Vec4;

namespace {

Vec4 read_vector(Arguments &words)
{
  Vec4 v{};
  for (int d = 0; d < 3; ++d) v[d] = words.number<double>();
  return v;
}

// What fits every scene and box.
template <class Shape>
class Fits : public nscd::ObstacleOf<Shape> {
  void require_planar(const std::string &) const override {}
  void require_repeats(const std::string &, const BoxEdges &) const override {}
};

// The inside of a sphere about a centre, which spins: x y z R wx wy wz.
class Shell final : public Fits<Shell> {
 public:
  Shell(const Vec4 &middle, double radius, const Vec4 &spin) : middle_(middle), spin_(spin), radius_(radius) {}
  double distance(const Vec4 &centre) const { return radius_ - nscd::length(centre - middle_); }
  Touch at(const Vec4 &centre, double radius, int) const override
  {
    const Vec4 out = centre - middle_;
    return {-out / std::max(nscd::length(out), 1e-12), distance(centre) - radius, 0};
  }
  bool is_curved() const override { return true; }
  std::shared_ptr<const Obstacle> after(double, double) const override
  {
    return nscd::dot(spin_, spin_) > 0 ? std::make_shared<Shell>(*this) : nullptr;
  }
  Vec4 velocity_at(const Vec4 &point, const Touch &) const override { return nscd::cross(spin_, point - middle_); }

 private:
  Vec4 middle_, spin_;
  double radius_;
};

// Two planes that meet in an edge along y and rise on both sides of it, with a slope of 45 degrees: x z.
class Groove final : public Fits<Groove> {
 public:
  Groove(double x, double z) : edge_{x, 0, z, 0} {}
  double distance(const Vec4 &centre) const { return std::min(height(centre, 0), height(centre, 1)); }
  Touch at(const Vec4 &centre, double radius, int side) const override
  {
    return {normal(side), height(centre, side) - radius, side};
  }
  void touch(const Vec4 &centre, double radius, double within, std::vector<Touch> &found) const override
  {
    for (const int side : {0, 1})
      if (height(centre, side) - radius <= within) found.push_back(at(centre, radius, side));
  }

 private:
  static Vec4 normal(int side) { return Vec4{side ? -M_SQRT1_2 : M_SQRT1_2, 0, M_SQRT1_2, 0}; }
  double height(const Vec4 &centre, int side) const { return nscd::dot(normal(side), centre - edge_); }
  Vec4 edge_;
};

// A plane that moves: x y z, its normal, its velocity.
class Piston final : public Fits<Piston> {
 public:
  Piston(const Vec4 &point, const Vec4 &normal, const Vec4 &velocity) :
      point_(point), normal_(normal / nscd::length(normal)), velocity_(velocity)
  {
  }
  double distance(const Vec4 &centre) const { return nscd::dot(normal_, centre - point_); }
  Touch at(const Vec4 &centre, double radius, int) const override { return {normal_, distance(centre) - radius, 0}; }
  std::shared_ptr<const Obstacle> after(double time, double) const override
  {
    return std::make_shared<Piston>(point_ + velocity_ * time, normal_, velocity_);
  }
  Vec4 velocity_at(const Vec4 &, const Touch &) const override { return velocity_; }
  double fastest(const Vec4 &, double) const override { return std::abs(nscd::dot(normal_, velocity_)); }

 private:
  Vec4 point_, normal_, velocity_;
};

std::shared_ptr<const Obstacle> read_shell(Arguments &words, const std::string &)
{
  const Vec4 middle = read_vector(words);
  const double radius = words.number<double>();
  return std::make_shared<Shell>(middle, radius, read_vector(words));
}

std::shared_ptr<const Obstacle> read_groove(Arguments &words, const std::string &)
{
  const double x = words.number<double>();
  return std::make_shared<Groove>(x, words.number<double>());
}

std::shared_ptr<const Obstacle> read_piston(Arguments &words, const std::string &)
{
  const Vec4 point = read_vector(words), normal = read_vector(words);
  return std::make_shared<Piston>(point, normal, read_vector(words));
}

const nscd::RegisterObstacle shell({910, "shell", "x y z R wx wy wz", "", read_shell});
const nscd::RegisterObstacle groove({920, "groove", "x z", "", read_groove});
const nscd::RegisterObstacle piston({930, "piston", "x y z nx ny nz vx vy vz", "", read_piston});

constexpr double gravity = 10;
const std::string solved_well = " criterion paper tol 1e-12 maxiter 10000 ";

void fall(Step &step, Scene &scene, int steps, double dt)
{
  for (int k = 0; k < steps; ++k) {
    scene.accelerate({0, 0, -gravity});
    scene.advance(step, dt);
    scene.just_built = false;
  }
}

}    // namespace

TEST(a_new_kind_of_wall_is_a_choice_like_the_others)
{
  CHECK_ERROR(settings("wall cone 0 0 0"), "unknown wall 'cone': choose one of plane");
  CHECK(settings("wall groove 0 0 friction 0.3 wall shell 0 0 0 5 0 0 0").walls.size() == 2);
}

// Of every kind: the normal is how the gap grows, distances are those of the nearest feature, features within reach are
// found, and a wall that moves comes nearer by the velocity of its surface. Kinds are asked with some numbers and file.
TEST(what_a_kind_of_wall_says_of_itself_holds)
{
  const std::string file = write_ascii(globe(1, 8, 5), "some.stl");
  for (const nscd::ObstacleEntry &kind : nscd::obstacle_kinds()) {
    const double some[] = {0.1, 0.2, 0.3, 5, 0.5, 0.25, 0.125, 0.4, 0.6, 0.7, 0.9, 1.1};
    std::vector<std::string> numbers;
    std::istringstream words{std::string(kind.words)};
    for (std::string word; words >> word;)
      numbers.push_back(word == "FILE" ? file : std::to_string(some[numbers.size()]));
    Arguments arguments(numbers);
    const auto wall = kind.read(arguments, "wall 1");
    CHECK(!numbers.empty() && arguments.done());
    Random random(5);
    for (int k = 0; k < 200; ++k) {
      const Vec4 centre{random(-2, 2), random(-2, 2), random(-2, 2), 0};
      std::vector<Touch> touches;
      wall->touch(centre, 0.5, 1e9, touches);
      double nearest = 1e9;
      for (const Touch &touch : touches) {
        nearest = std::min(nearest, touch.gap + 0.5);
        CHECK_NEAR(nscd::length(touch.normal), 1, 1e-12);
        const double h = 1e-6;
        const auto gap = [&](const Obstacle &of, const Vec4 &at) { return of.at(at, 0.5, touch.feature).gap; };
        CHECK_NEAR(gap(*wall, centre), touch.gap, 1e-12);
        CHECK_NEAR(gap(*wall, centre + touch.normal * h) - gap(*wall, centre - touch.normal * h), 2 * h, 1e-6 * h);
        std::vector<Touch> within;
        wall->touch(centre, 0.5, touch.gap + 1e-9, within);
        CHECK(!within.empty());
        const auto later = wall->after(h, h), sooner = wall->after(-h, h);
        if (!later) continue;
        const Vec4 velocity = wall->velocity_at(centre - touch.normal * (0.5 + touch.gap), touch);
        CHECK_NEAR(gap(*later, centre) - gap(*sooner, centre), -2 * h * nscd::dot(touch.normal, velocity), 1e-6 * h);
        CHECK(nscd::dot(touch.normal, velocity) <= wall->fastest(centre, 0.5 + touch.gap) + 1e-12);
      }
      const nscd::Sphere sphere{centre, 0.5, 0};
      std::vector<std::int32_t> near;
      wall->find_near({&sphere, 1}, nearest - 0.5 + 1e-9, near);
      CHECK(!touches.empty() && near == std::vector<std::int32_t>{0});
    }
  }
  std::filesystem::remove(file);
}

// Along a wall that curves towards the grain any plane is too far. A bead that slides through the lowest point of a
// shell has v^2 = 2 g h there, to first order in dt: where a wall turns a grain in, all of its impulse has to displace.
TEST(a_bead_slides_along_the_inside_of_a_shell)
{
  const double shell_radius = 5, r = 1, path = shell_radius - r, angle = 0.5;
  const double top = path * (1 - std::cos(angle)), speed = std::sqrt(2 * gravity * top);
  double error[2];
  for (const int finer : {0, 1}) {
    const double dt = finer ? 1e-3 : 2e-3;
    Scene scene;
    scene.add({path * std::sin(angle), 0, -path * std::cos(angle)}, r, 2);
    Step step(settings("wall shell 0 0 0 5 0 0 0" + solved_well));
    double overlap = 0, lowest = 1;
    while (scene.x[0] > 0) {
      fall(step, scene, 1, dt);
      overlap = std::max(overlap, step.report().largest_overlap);
      lowest = std::min(lowest, 1 + scene.x[0]);
    }
    error[finer] = std::abs(std::hypot(scene.v[0], scene.v[2]) / speed - 1);
    // Of its velocity that of a step's kick is not foreseen, g dt: it comes round by g dt^2 v / R more than was seen.
    CHECK(overlap < 0.5 * gravity * dt * dt * speed * dt / path + 1e-9);
  }
  CHECK(error[0] < 6e-4 && error[1] < 0.55 * error[0]);
}

// A shell that spins about a level axis drags a grain at its bottom with mu g until it rolls, and never holds it less
// than a grain that weighs m g.
TEST(a_shell_that_spins_drags_grains_along)
{
  for (const char *law : {"law gap", "law moreau"}) {
    const double mu = 0.1, dt = 1e-4, surface = 0.2 * 50;
    Scene scene;
    scene.add({0, 0, -49}, 1, 2);
    Step step(settings(std::string(law) + " friction 0.1 wall shell 0 0 0 50 0 -0.2 0" + solved_well));
    fall(step, scene, 200, dt);
    CHECK_NEAR(scene.v[0], mu * gravity * 200 * dt, 2e-3 * mu * gravity * 200 * dt);
    CHECK_NEAR(scene.omega[1], -2.5 * mu * gravity * 200 * dt, 5e-3 * mu * gravity * 200 * dt);
    // Two sevenths of the surface's speed: it rolls then. The bottom is no longer level by then.
    const double rolls = surface / (3.5 * mu * gravity);
    CHECK(step.report().converged && rolls > 1);
    const double slip = surface - 3.5 * mu * gravity * 199.5 * dt;
    CHECK_NEAR(step.report().dissipated_in_step, mu * 2 * gravity * dt * slip, 1e-5);
  }
}

// Each side of a groove carries m g / sqrt 2, and each is a contact with an impulse that is kept for the next step.
TEST(a_groove_is_two_contacts_of_one_grain)
{
  for (const std::string law : {"law gap", "law moreau"})
    for (const std::string friction : {"", " friction 0.5"}) {
      const double dt = 1e-3;
      Scene scene;
      scene.add({0, 0, M_SQRT2 - 1e-12}, 1, 2);
      Step step(settings(law + friction + " wall groove 0 0" + solved_well));
      fall(step, scene, 3, dt);
      const auto &table = step.state().table;
      CHECK(table.size() == 2 && table.infos[0].key != table.infos[1].key);
      Vec4 push{};   // with friction the two may also hold it by their sides
      for (std::size_t k = 0; k < 2; ++k)
        push += table.contacts[k].normal * table.contacts[k].impulse + nscd::tangential_impulse(step.state(), k);
      CHECK_NEAR(push[0], 0, 1e-12);
      CHECK_NEAR(push[2], 2 * gravity * dt, 1e-9);
      if (friction.empty()) CHECK_NEAR(table.contacts[0].impulse, 2 * gravity * dt * M_SQRT1_2, 1e-9);
      CHECK_NEAR(scene.x[0], 0, 1e-12);
      std::vector<double> rows(2 * std::size_t(nscd::contact_columns(step.settings())));
      nscd::fill_contact_rows(step.state(), rows.data());
      CHECK(rows[1] == -1 && rows[rows.size() / 2 + 1] == -1);   // of wall 0, both
    }
}

TEST(a_heap_in_a_groove_starts_warm)
{
  for (const std::string friction : {"", " friction 0.1"}) {
    int iterations[2];
    for (const bool warm : {false, true}) {
      Scene scene;
      for (int k = 0; k < 5; ++k) scene.add({0, 1.999 * k, M_SQRT2 - 1e-4}, 1, 1 + k);
      for (int k = 0; k < 4; ++k) scene.add({0, 1.999 * k + 1, M_SQRT2 + 1.7}, 1, 3);
      const std::string words = " solver pdas criterion paper tol 1e-6 wall groove 0 0 wall plane 0 -1 0 0 1 0";
      Step step(settings("law gap" + friction + words + " wall plane 0 9 0 0 -1 0 warmstart " + (warm ? "yes" : "no")));
      fall(step, scene, 40, 1e-3);
      iterations[warm] = step.report().iterations;
    }
    CHECK(iterations[0] > 10 && iterations[1] < iterations[0] / 2);
  }
}

// Grains that a piston hits leave it at (1 + e) its speed, however the step lies; and what it gives them it has not
// taken from them: they lose what an impact with a standing wall of their relative speed loses.
TEST(a_piston_pushes)
{
  for (const std::string law : {"law gap", "law moreau"})
    for (const double e : {0.0, 0.5, 1.0})
      for (const std::string friction : {"", " friction 0.3 e_t 0.5"}) {
        const double speed = 3, dt = 1e-2, mass = 2;
        Scene scene;
        scene.add({1.1, 0, 0}, 1, mass);
        const std::string rebound = " restitution " + std::to_string(e);
        Step step(settings(law + friction + rebound + " wall piston 0 0 0 1 0 0 3 0 0" + solved_well));
        double dissipated = 0;
        for (int k = 0; k < 20; ++k) {
          scene.accelerate({0, 0, 0});
          scene.advance(step, dt);
          dissipated += step.report().dissipated_in_step;
          // Law gap has none but where the impact waits for its turn; law moreau sees it late, by up to a step's way.
          CHECK(step.report().largest_overlap < (law == "law gap" ? 1e-9 : 1.01 * speed * dt));
        }
        CHECK_NEAR(scene.v[0], (1 + e) * speed, 1e-9);
        CHECK_NEAR(dissipated, 0.5 * mass * speed * speed * (1 - e * e), 1e-9);
        CHECK(e > 0 || step.report().contacts == 1);
      }
}

// A column between a piston and a wall that stands far behind: all of it moves with the piston.
TEST(a_piston_pushes_a_column_of_grains)
{
  for (const std::string friction : {"", " friction 0.5"}) {
    Scene scene;
    for (int k = 0; k < 6; ++k) scene.add({1.02 + 2.01 * k, 0, 0}, 1, 1 + k % 3);
    Step step(settings("law gap" + friction + " wall piston 0 0 0 1 0 0 1 0 0" + solved_well));
    for (int k = 0; k < 20; ++k) {
      scene.accelerate({0, 0, 0});
      scene.advance(step, 1e-2);
      scene.just_built = false;
      CHECK(step.report().largest_overlap < 1e-9);
    }
    for (int k = 0; k < 6; ++k) CHECK_NEAR(scene.v[3 * k], 1, 1e-9);
  }
}

// A tray that moves sideways takes what lies on it along, with mu g.
TEST(a_wall_that_moves_along_itself_drags)
{
  const double mu = 0.3, dt = 1e-3;
  Scene scene;
  scene.add({0, 0, 1}, 1, 2);
  Step step(settings("friction 0.3 wall piston 0 0 0 0 0 1 5 0 0" + solved_well));
  fall(step, scene, 100, dt);
  CHECK_NEAR(scene.v[0], mu * gravity * 100 * dt, 1e-9);
  CHECK_NEAR(scene.omega[1], -2.5 * mu * gravity * 100 * dt, 1e-9);
  fall(step, scene, 900, dt);   // it rolls: slip is over at 2 v / (7 mu g), and what is left is the spin that it has
  CHECK_NEAR(scene.v[0] - scene.omega[1], 5, 1e-9);
  CHECK_NEAR(scene.v[0], 5 * 2.0 / 7, 1e-9);
}

// Grains for a spinning shell, above a groove, beside a piston.
static Scene cloud(int rank, int count)
{
  Random random(12);
  Scene all;
  for (int i = 0; i < 64; ++i) {
    Point centre{2.001 * (i % 4) - 3, 2.001 * (i / 4 % 4) - 3, 2.001 * (i / 16) - 3};
    for (double &c : centre) c += random(-1, 1) * 1e-3;
    const Point velocity{random(-1, 1), random(-1, 1), random(-1, 1)};
    all.add(centre, 1, random(0.5, 1.5), velocity);
  }
  return part_of_rank(all, rank, [&](int i) { return std::min(count - 1, int((all.x[3 * i] + 4) / 8 * count)); });
}

static std::vector<double> after_a_step(const std::string &words, int count)
{
  std::vector<double> found(6 * 65 + 1);
  on_ranks(count, [&](ThreadRanks &ranks) {
    Scene scene = cloud(ranks.rank(), count);
    const std::string walls =
        " wall shell 0 0 0 6.2 0.1 0.2 0.3 wall groove 0 -7.4142 wall piston 0 -4 0 0 1 0 0.3 1 0.1";
    Step step(settings(words + walls + " maxiter 100000 solver apgs criterion paper tol 1e-11"), {}, 3, &ranks);
    scene.accelerate({0, 0, -gravity});
    const nscd::StepReport &report = scene.advance(step, 1e-3);
    CHECK(report.converged);
    if (ranks.rank() == count - 1) found.back() = report.largest_overlap;
    for (int i = 0; i < scene.owned; ++i)
      for (int d = 0; d < 3; ++d) {
        found[std::size_t(6 * scene.tag[i] + d)] = scene.v[3 * i + d];
        found[std::size_t(6 * scene.tag[i] + 3 + d)] = scene.omega[3 * i + d];
      }
  });
  return found;
}

TEST(any_number_of_ranks_gives_one_answer_beside_walls_that_curve_and_move)
{
  for (const std::string words : {"law gap", "law moreau", "law gap friction 0.3", "law gap restitution 0.5",
                                  "law gap friction 0.05 restitution 0.5"}) {
    const std::vector<double> one = after_a_step(words, 1);
    for (const int count : {2, 3}) {
      const std::vector<double> several = after_a_step(words, count);
      CHECK(several == after_a_step(words, count));
      // Overlaps by g dt^2 / 2: a grain is moved by its mean velocity or by that at the end, as round-off has it.
      CHECK_NEAR(several.back(), one.back(), 0.51 * gravity * 1e-6);
      for (std::size_t k = 0; k + 1 < one.size(); ++k) CHECK_NEAR(several[k], one[k], 1e-6);
    }
  }
}

// What an all-pairs look at the end of a step sees of overlaps is what is reported: with walls that have moved on.
TEST(overlaps_with_walls_are_those_at_the_end_of_the_step)
{
  for (const std::string words : {"law gap friction 0.3", "law gap restitution 0.5", "law moreau restitution 0.3"}) {
    Scene scene = cloud(0, 1);
    Step step(settings(words + " wall shell 0 0 0 6.2 0.1 0.2 0.3 wall piston 0 -4 0 0 1 0 0 1 0 unconverged ignore"));
    for (int k = 0; k < 60; ++k) {
      scene.accelerate({0, 0, -gravity});
      scene.advance(step, 2e-3);
      scene.just_built = false;
      const double face = -4 + 2e-3 * (k + 1);
      double overlap = 0;
      for (int i = 0; i < scene.owned; ++i) {
        const double *x = &scene.x[3 * i];
        overlap = std::max({overlap, std::hypot(x[0], x[1], x[2]) + 1 - 6.2, face + 1 - x[1]});
        for (int j = 0; j < i; ++j) {
          const double *y = &scene.x[3 * j];
          overlap = std::max(overlap, 2 - std::hypot(x[0] - y[0], x[1] - y[1], x[2] - y[2]));
        }
      }
      CHECK_NEAR(step.report().largest_overlap, overlap, 1e-12);
    }
  }
}

TEST(a_step_that_is_refused_leaves_walls_where_they_were)
{
  Scene scene;
  scene.add({1.5, 0, 0}, 1, 1);
  Step step(settings("wall piston 0 0 0 1 0 0 1 0 0" + solved_well));
  scene.mass[0] = -1;
  CHECK_ERROR(scene.advance(step, 0.1), "mass");
  scene.mass[0] = 1;
  for (int k = 0; k < 5; ++k) {
    scene.accelerate({0, 0, 0});
    scene.advance(step, 0.1);
    CHECK_NEAR(scene.x[0], 1.5, 1e-12);   // it comes to touch after five
  }
  scene.accelerate({0, 0, 0});
  scene.advance(step, 0.1);
  CHECK_NEAR(scene.x[0], 1.6, 1e-9);
}
