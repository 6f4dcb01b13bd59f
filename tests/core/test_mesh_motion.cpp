// SPDX-License-Identifier: GPL-2.0-or-later
// How grains move on walls of triangles: as on a plane, off edges, in a tube.
#include "check.hpp"
#include "stl_files.hpp"

#include <filesystem>

using nscd::Step;

namespace {

constexpr double weight = 10;
const std::string well = " criterion paper tol 1e-12 maxiter 10000 ";

double level_ground(double, double) { return 0; }

void step_with_weight(Step &step, Scene &scene, double dt, const Point &weighs = {0, 0, -weight})
{
  scene.accelerate(weighs);
  scene.advance(step, dt);
  scene.just_built = false;
}

}    // namespace

// Any triangles of one plane are that plane.
TEST(a_ball_on_a_flat_mesh_feels_no_seams)
{
  const std::string path = write_ascii(terrain(10, 37, level_ground), "flat.stl");
  for (const std::string law : {"law gap", "law moreau"})
    for (const std::string friction : {"", " friction 0.5"})
      for (const double r : {0.05, 0.4, 2.0}) {
        const double dt = 5e-3, vx = 1.3, vy = 0.71;
        Scene on[2];
        for (Scene &scene : on) {
          scene.add({-4.1, -2.3, r}, r, 2, {vx, vy, 0});
          if (!friction.empty()) scene.omega = {-vy / r, vx / r, 0};
        }
        Step on_mesh(settings(law + friction + well + "wall mesh " + path));
        Step on_plane(settings(law + friction + well + "wall plane 0 0 0 0 0 1"));
        double worst = 0, apart = 0;
        for (int k = 0; k < 1000; ++k) {
          step_with_weight(on_mesh, on[0], dt);
          step_with_weight(on_plane, on[1], dt);
          CHECK(on_mesh.report().contacts == 1);
          worst = std::max({worst, std::abs(on[0].v[0] - vx), std::abs(on[0].v[1] - vy), std::abs(on[0].v[2])});
          for (int d = 0; d < 3; ++d)
            apart = std::max({apart, std::abs(on[0].x[d] - on[1].x[d]), std::abs(on[0].omega[d] - on[1].omega[d])});
        }
        CHECK_NEAR(worst, 0, 1e-10);
        CHECK_NEAR(apart, 0, 1e-10);
      }
  std::filesystem::remove(path);
}

// A plane that is tilted, with coordinates that are rounded to doubles: seams are flat within round-off.
TEST(a_ball_slides_down_a_tilted_mesh_as_down_a_plane)
{
  const auto slope = [](double x, double y) { return 0.3 * x + 0.2 * y; };
  const std::string path = write_ascii(terrain(10, 37, slope), "tilted.stl");
  for (const std::string friction : {"", " friction 0.1", " friction 1"}) {
    Scene on[2];
    for (Scene &scene : on) scene.add({4, 4, 2 + 0.3 * std::sqrt(1 + 0.13) + 0.01}, 0.3, 2);
    Step on_mesh(settings("law gap" + friction + well + "wall mesh " + path));
    Step on_plane(settings("law gap" + friction + well + "wall plane 0 0 0 -0.3 -0.2 1"));
    for (int k = 0; k < 400; ++k) {
      step_with_weight(on_mesh, on[0], 4e-3);
      step_with_weight(on_plane, on[1], 4e-3);
    }
    for (int d = 0; d < 3; ++d) CHECK_NEAR(on[0].x[d], on[1].x[d], 1e-9);
    CHECK(on[0].x[0] < 3);
  }
  std::filesystem::remove(path);
}

// Towards an edge, towards a vertex: back along the line that it came.
TEST(a_ball_bounces_straight_off_an_edge_and_a_vertex_of_a_mesh)
{
  const double diagonal = 1 / std::sqrt(3);
  const std::string path = write_binary(box_shape(2), "box.stl");
  for (const std::string law : {"law gap", "law moreau"})
    for (const Point &way : {Point{M_SQRT1_2, 0, M_SQRT1_2}, Point{diagonal, diagonal, diagonal}})
      for (const double e : {0.0, 0.5, 1.0}) {
        const bool is_edge = way[1] == 0;
        const double from = is_edge ? M_SQRT2 : std::sqrt(3), r = 0.3, dt = 1e-3, speed = 2;
        Scene scene;
        const double start = from + r + 0.0505;
        scene.add({start * way[0], is_edge ? 0.37 : start * way[1], start * way[2]}, r, 2,
                  {-speed * way[0], -speed * way[1], -speed * way[2]});
        Step step(settings(law + " friction 0.3 restitution " + std::to_string(e) + well + " wall mesh " + path));
        for (int k = 0; k < 60; ++k) {
          step_with_weight(step, scene, dt, {0, 0, 0});
          CHECK(step.report().largest_overlap < (law == "law gap" ? 1e-9 : 1.01 * speed * dt));
          for (const nscd::Contact &contact : step.state().table.contacts)
            for (int d = 0; d < 3; ++d) CHECK_NEAR(contact.normal[d], way[std::size_t(d)], 1e-9);
        }
        for (int d = 0; d < 3; ++d) CHECK_NEAR(scene.v[d], e * speed * way[std::size_t(d)], 1e-9);
        for (int d = 0; d < 3; ++d) CHECK_NEAR(scene.omega[d], 0, 1e-8);
      }
  std::filesystem::remove(path);
}

// A ball that rolls off a table turns about its edge, and leaves it no sooner than by its weight.
TEST(a_ball_falls_off_the_edge_of_a_mesh)
{
  const std::string path = write_ascii(box_shape(3), "table.stl");
  for (const double dt : {4e-3, 1e-3}) {
    const double r = 0.4;
    Scene scene;
    scene.add({0.9, 0.1, 1 + r}, r, 2, {0.3, 0, 0});
    Step step(settings("law gap" + well + "wall mesh " + path));
    double overlap = 0, energy = 0.045 + weight * (1 + r);
    for (double time = 0; time < 1.6; time += dt) {
      step_with_weight(step, scene, dt);
      overlap = std::max(overlap, step.report().largest_overlap);
      const double now =
          0.5 * (scene.v[0] * scene.v[0] + scene.v[2] * scene.v[2]) + weight * scene.x[2];
      CHECK(now < energy + 0.02 * weight * r);
      energy = std::min(energy, now);
    }
    CHECK(scene.x[0] > 1.2 && scene.x[2] < 0);
    CHECK_NEAR(scene.x[1], 0.1, 1e-9);
    CHECK(overlap < 1e-3 * r);
  }
  std::filesystem::remove(path);
}

// A pendulum of the length R - r, without friction; about the axis z, which here lies level. Its slope is a staircase,
// so its period is another one by a share of the stairs' width, 2 pi / facets.
TEST(a_ball_swings_in_a_tube_of_triangles)
{
  const double r = 0.1, l = 1 - r, dt = 1e-3, angle = 0.3;
  for (const std::string law : {"law gap", "law moreau"})
    for (const int facets : {60, 120, 240, 480}) {
      const std::string path = write_ascii(tube(1 / std::cos(M_PI / facets), 1, facets, 7), "tube.stl");
      Scene scene;
      scene.add({l * std::sin(angle), -l * std::cos(angle) + 1e-6, 0.03}, r, 2);
      Step step(settings(law + well + "wall mesh " + path));
      double before = scene.x[0], overlap = 0;
      std::vector<double> passes;
      for (int k = 0; k < 6000; ++k) {
        step_with_weight(step, scene, dt, {0, -weight, 0});
        if (before > 0 && scene.x[0] <= 0) passes.push_back(dt * (k + before / (before - scene.x[0])));
        before = scene.x[0];
        overlap = std::max(overlap, step.report().largest_overlap);
      }
      CHECK(passes.size() >= 3 && overlap < 1e-3 * r);
      const double period = (passes.back() - passes.front()) / double(passes.size() - 1);
      const double expected = 2 * M_PI * std::sqrt(l / weight) * (1 + angle * angle / 16);
      CHECK_NEAR(period / expected, 1, 0.1 * 2 * M_PI / facets);
      CHECK_NEAR(scene.x[2], 0.03, 1e-9);
      std::filesystem::remove(path);
    }
}

// In the plane: a disc between the sides of a tube, which has no seams for it either.
TEST(a_disc_rolls_in_a_tube_of_triangles)
{
  const std::string path = write_ascii(tube(1, 1, 40, 3), "tube.stl");
  Scene scene;
  scene.add({0.3, -0.5, 0.01}, 0.2, 2);
  Step step(settings("law gap friction 0.3" + well + "wall mesh " + path), {}, 2);
  for (int k = 0; k < 2000; ++k) {
    step_with_weight(step, scene, 2e-3, {0, -weight, 0});
    CHECK(scene.v[2] == 0 && scene.omega[0] == 0 && step.report().largest_overlap < 1e-6);
  }
  CHECK_NEAR(std::hypot(scene.x[0], scene.x[1]), 0.8, 0.01);
  std::filesystem::remove(path);
}
