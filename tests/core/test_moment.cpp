// SPDX-License-Identifier: GPL-2.0-or-later
// The plane of a pair that has moved on (core/contact/moment.hpp).
#include "check.hpp"
#include "contact/moment.hpp"
#include "scene.hpp"

#include <cmath>

// A step that takes planes back to the start asks which have one elsewhere: round-off would keep it asking for ever.
TEST(pair_that_has_not_moved_has_no_curve)
{
  Random random(1);
  for (int i = 0; i < 1000; ++i) {
    const nscd::Vec4 separation{random(-1, 1), random(-1, 1), random(-1, 1), 0};
    const double distance = nscd::length(separation);
    CHECK(nscd::turned(separation, distance, nscd::Vec4{}).curve == 0);
  }
}

// d (cos a - 1), a the angle by which a small way turns the pair, to all digits; as a difference it would have few.
TEST(curve_of_a_small_way_is_exact_and_never_beyond_the_surface)
{
  for (double way = 1e-7; way < 0.5; way *= 3) {
    const nscd::Vec4 separation{0, 0, 2, 0};
    const double angle = std::atan2(way, 2), half = std::sin(angle / 2);
    const double curve = nscd::turned(separation, 2, nscd::Vec4{way, 0, 0, 0}).curve;
    CHECK(curve < 0);
    CHECK_NEAR(curve, -4 * half * half, 1e-8 * 4 * half * half);
  }
}
