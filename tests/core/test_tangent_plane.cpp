// SPDX-License-Identifier: GPL-2.0-or-later
// Tangential impulses in space stay perpendicular to their normals, however long a law takes.
#include "check.hpp"
#include "scene.hpp"
#include "scene/slides.hpp"

#include <algorithm>
#include <cmath>

// Largest share of an impulse that lies along the normal.
static double out_of_tangent_planes(const nscd::State &s)
{
  double worst = 0;
  for (std::size_t k = 0; k < s.table.contacts.size(); ++k) {
    const nscd::Vec4 p = nscd::tangential_impulse(s, k);
    const double size = nscd::length(p) + std::abs(s.table.contacts[k].impulse);
    if (size > 0) worst = std::max(worst, std::abs(nscd::dot(p, s.table.contacts[k].normal)) / size);
  }
  return worst;
}

TEST(tangential_impulses_stay_in_their_tangent_planes)
{
  for (const auto &solver : nscd::frictional_solvers())
    for (int seed = 0; seed < 12; ++seed) {
      Random random(seed);
      Scene scene = random_scene(random, 40, 1, 0.12, 5);
      for (double &w : scene.omega) w = random(-50, 50);
      const std::string words = "law moreau friction 3 e_t 1 unconverged ignore solver " + std::string(solver.name);
      nscd::Step step(settings(words + box_walls(1, 1)));
      const double dt = random(1e-4, 5e-3);
      for (int k = 0; k < 40; ++k) {
        scene.accelerate({0, 0, -10});
        try {
          scene.advance(step, dt);
        } catch (const nscd::Error &) {
          break;  // an overlap of a grain as small as its step
        }
        CHECK(out_of_tangent_planes(step.state()) < 1e-10);
      }
    }
}
