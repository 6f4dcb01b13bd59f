// SPDX-License-Identifier: GPL-2.0-or-later
// Solves contact problems with parts and bodies that only tests have, by every solver, on bodies and by their matrix.
// tests/test_contact_parts.py writes the problems, and judges the answers by an assembly and natural maps of its own.
//
//   solve_parts KIND TOL MAXITER < problem > answers
//
// The problem: numbers of bodies and contacts. A body: 1/m, the inverse inertia by rows (9; of spheres and discs k / m
// in the first), velocity and spin (3, 3). A contact: bodies i and j, normal, arms of i and of j (3 each), mu, mu_r,
// the weights of rolling, which twisting has too, and mu_w. Out: for each solver and door a line with its name, how it
// ended, and impulses in space, contact by contact: p_n, p_t (3), p_r (3), p_w.
#include "parts/rigid_bodies.hpp"
#include "parts/roll.hpp"
#include "parts/twist.hpp"
#include "problem/delassus_of.hpp"
#include "problem/criterion_of.hpp"
#include "problem/own_blocks.hpp"
#include "solver/global/auto.hpp"
#include "solver/local/eal.hpp"
#include "solver/local/ebp.hpp"
#include "solver/local/sal.hpp"
#include "solver/local/sbp.hpp"
#include "solver/normal_sweeps_of.hpp"

#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <string>
#include <string_view>

using nscd::Spatial;
using nscd::Vec4;

static double number()
{
  double x;
  if (!(std::cin >> x)) std::exit(2);
  return x;
}

static Vec4 vector()
{
  Vec4 v{};
  for (int d = 0; d < 3; ++d) v[d] = number();
  return v;
}

template <class Space>
struct Given {
  nscd::AlignedVector<nscd::Body> bodies{};
  nscd::AlignedVector<Vec4> spins{};
  nscd::AlignedVector<RigidBodies::Inertia> inertias{};
  nscd::AlignedVector<nscd::Contact> contacts{};
  nscd::AlignedVector<RigidBodies::Arms> arms{};
  nscd::AlignedVector<nscd::Slide<Space>> slides{};
  nscd::AlignedVector<Roll<Space>> rolls{};
  nscd::AlignedVector<Twist> twists{};
  double response = 0;

  void read()
  {
    const int n = int(number()), m = int(number());
    for (int b = 0; b < n; ++b) {
      const double inverse_mass = number();
      RigidBodies::Inertia inertia{};
      for (auto &row : inertia.inverse) row = vector();   // symmetric
      if (inverse_mass > 0) response = inertia.inverse[0][0] / inverse_mass;
      nscd::Body v = vector();
      v[3] = inverse_mass;
      bodies.push_back(v);
      spins.push_back(vector());
      inertias.push_back(inertia);
    }
    for (int k = 0; k < m; ++k) {
      nscd::Contact c{};
      c.i = int(number());
      c.j = int(number());
      c.normal = vector();
      const Vec4 arm_i = vector();
      arms.push_back({arm_i, vector()});
      nscd::Slide<Space> slide{};
      Roll<Space> roll{};
      slide.mu = number();
      roll.mu = number();
      roll.weight_i = number();
      roll.weight_j = number();
      Twist twist{};
      twist.mu = number();
      twist.weight_i = roll.weight_i;
      twist.weight_j = roll.weight_j;
      twists.push_back(twist);
      slides.push_back(slide);
      rolls.push_back(roll);
      contacts.push_back(c);
    }
  }
};

static void print(double x) { std::printf(" %a", x); }

static void print(const Vec4 &v)
{
  for (int d = 0; d < 3; ++d) print(v[d]);
}

// In space. A number of the plane slides along t or rolls about z, a number in space twists about n.
template <class Space>
static void print_disc(std::size_t, const Vec4 &, const Vec4 &p)
{
  print(p);
}
template <class Space>
static void print_disc(std::size_t number, const Vec4 &n, double p)
{
  if constexpr (std::is_same_v<Space, Spatial>) print(p);
  else print(number == 0 ? nscd::Planar::in_space(n, p) : Vec4{0, 0, p, 0});
}

template <class Space, class M>
static void print_answer(std::string_view solver, std::string_view door, const nscd::SolverReport &report,
                         const M &mechanics, const Given<Space> &given)
{
  std::printf("%.*s %.*s %d %d %a", int(solver.size()), solver.data(), int(door.size()), door.data(), report.converged,
              report.iterations, report.criterion.relative);
  for (std::size_t k = 0; k < given.contacts.size(); ++k) {
    const nscd::Contact &c = given.contacts[k];
    const auto p = mechanics.impulse(c, k);
    print(p.n);
    nscd::for_each_disc([&](std::size_t d, const auto &one) { print_disc<Space>(d, c.normal, one); }, p.t);
    if (M::parts == 1) std::printf(" 0 0 0");
    if (M::parts < 3) std::printf(" 0");
  }
  std::printf("\n");
}

// `make` makes the mechanics of a copy of what is given; solve(problem, mechanics, options) solves it.
template <class Space, class Make, class Solve>
static void solve(std::string_view solver, std::string_view door, const Given<Space> &original, Make make, Solve solve,
                  const nscd::SolverOptions &options)
{
  Given<Space> given = original;
  nscd::Workspace workspace;
  auto mechanics = make(given);
  nscd::Problem problem{given.bodies, given.contacts, 0, workspace};
  problem.sliding.spins = given.spins.data();
  auto own = nscd::own_blocks(problem, mechanics);
  mechanics.take_own_blocks(own.data());
  double free2 = 0;
  for (std::size_t k = 0; k < given.contacts.size(); ++k) {
    given.contacts[k].w_inverse = own[k].w_inverse;
    const auto v = mechanics.velocity(given.contacts[k], k);
    free2 += v.n * v.n + nscd::inner(v.t, v.t);
  }
  problem.free_norm = std::sqrt(free2);
  const nscd::SolverReport report = solve(problem, mechanics, options);
  print_answer(solver, door, report, mechanics, given);
}

// A solver with its two doors: the bodies themselves, and their matrix.
template <class Solver, class Space, class Make>
static void both(std::string_view solver, const Given<Space> &given, Make make, nscd::SolverOptions options,
                 double parameter)
{
  options.parameter = parameter;
  solve(solver, "bodies", given, make, [](nscd::Problem &problem, const auto &mechanics, const auto &asked) {
    return Solver::solve(problem, mechanics, asked);
  }, options);
  solve(solver, "matrix", given, make, [](nscd::Problem &problem, const auto &mechanics, const auto &asked) {
    return nscd::Assembled<Solver>::solve(problem, mechanics, asked);
  }, options);
}

template <class Space, class Make>
static void all_solvers(const nscd::SolverOptions &options, Make make)
{
  using namespace nscd;
  constexpr double step = 0.15;   // rho of SBP and SAL: below 2 / W of every part
  Given<Space> given;
  given.read();
  both<Nlgs<Sbp>>("sbp", given, make, options, step);
  both<Nlgs<Sal>>("sal", given, make, options, step);
  both<Nlgs<Ebp>>("ebp", given, make, options, 1);
  both<Nlgs<Eal>>("eal", given, make, options, 1);
  both<Nlgs<Pdas>>("pdas", given, make, options, 1);
  both<Apgs>("apgs", given, make, options, 1);
  both<Auto>("auto", given, make, options, 1);
  both<Assembled<InteriorPoint>>("interior_point", given, make, options, 1);
}

template <class Space>
static auto spheres(Given<Space> &given)
{
  return nscd::Spheres<Space>(given.bodies.data(), given.spins.data(), given.response);
}

static RigidBodies rigid(Given<Spatial> &given)
{
  return RigidBodies(given.bodies.data(), given.spins.data(), given.inertias.data(), given.arms.data());
}

int main(int words, char **word)
{
  if (words != 4) return 2;
  const std::string_view kind = word[1];
  nscd::SolverOptions options;
  options.stop = nscd::Stop::natural;
  options.tol = std::atof(word[2]);
  options.maxiter = std::atoi(word[3]);
  using nscd::Mechanics, nscd::Planar, nscd::Slide, nscd::Spheres;
  if (kind == "rolling_spheres")
    all_solvers<Spatial>(options, [](auto &g) {
      return Mechanics<Spheres<Spatial>, Slide<Spatial>, Roll<Spatial>>(spheres(g), g.slides.data(), g.rolls.data());
    });
  else if (kind == "rolling_discs")
    all_solvers<Planar>(options, [](auto &g) {
      return Mechanics<Spheres<Planar>, Slide<Planar>, Roll<Planar>>(spheres(g), g.slides.data(), g.rolls.data());
    });
  else if (kind == "rigid_bodies")
    all_solvers<Spatial>(options, [](auto &g) {
      return Mechanics<RigidBodies, Slide<Spatial>>(rigid(g), g.slides.data());
    });
  else if (kind == "rolling_bodies")
    all_solvers<Spatial>(options, [](auto &g) {
      return Mechanics<RigidBodies, Slide<Spatial>, Roll<Spatial>>(rigid(g), g.slides.data(), g.rolls.data());
    });
  else if (kind == "twisting_spheres")
    all_solvers<Spatial>(options, [](auto &g) {
      return Mechanics<Spheres<Spatial>, Slide<Spatial>, Roll<Spatial>, Twist>(spheres(g), g.slides.data(),
                                                                              g.rolls.data(), g.twists.data());
    });
  else if (kind == "twisting_bodies")
    all_solvers<Spatial>(options, [](auto &g) {
      return Mechanics<RigidBodies, Slide<Spatial>, Roll<Spatial>, Twist>(rigid(g), g.slides.data(), g.rolls.data(),
                                                                          g.twists.data());
    });
  else return 2;
}
