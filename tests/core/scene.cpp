// SPDX-License-Identifier: GPL-2.0-or-later
#include "scene.hpp"

#include <cmath>
#include <sstream>

int Scene::add(const Point &centre, double r, double m, const Point &velocity)
{
  x.insert(x.end(), centre.begin(), centre.end());
  v.insert(v.end(), velocity.begin(), velocity.end());
  for (auto *zero : {&f, &omega, &torque}) zero->insert(zero->end(), 3, 0.0);
  radius.push_back(r);
  mass.push_back(m);
  tag.push_back(owned + 1);
  mask.push_back(1);
  return owned++;
}

int Scene::add_obstacle(const Point &centre, double r)
{
  const int i = add(centre, r);
  mask[i] = 2;
  return i;
}

int Scene::add_image(int of, const Point &shift)
{
  for (int d = 0; d < 3; ++d) x.push_back(x[3 * of + d] + shift[d]);
  radius.push_back(radius[of]);
  tag.push_back(tag[of]);
  return int(tag.size()) - 1;
}

int Scene::add_foreign_image(const Point &centre, double r, std::int32_t its_tag, int rank)
{
  x.insert(x.end(), centre.begin(), centre.end());
  radius.push_back(r);
  tag.push_back(its_tag);
  home.push_back(rank);
  return int(tag.size()) - 1;
}

void Scene::accelerate(const Point &a)
{
  for (int i = 0; i < owned; ++i)
    for (int d = 0; d < 3; ++d) f[3 * i + d] = mass[i] * a[d];
  torque.assign(torque.size(), 0.0);
}

// LAMMPS lists a pair with an image once under newton (which of the two sides is its choice), else twice.
bool Scene::is_listed(int i, int j) const { return j < owned || !newton || tag[i] < tag[j]; }

void Scene::list_all_pairs()
{
  std::vector<std::vector<int>> neighbors(owned);
  for (int i = 0; i < owned; ++i)
    for (int j = i + 1; j < int(tag.size()); ++j)
      if (is_listed(i, j)) neighbors[i].push_back(j);
  list_pairs(neighbors);
}

void Scene::list_pairs(const std::vector<std::vector<int>> &neighbors_of)
{
  neighbors_ = neighbors_of;
  atoms_.clear();
  counts_.clear();
  for (const auto &neighbors : neighbors_) {
    atoms_.push_back(int(atoms_.size()));
    counts_.push_back(int(neighbors.size()));
  }
}

nscd::Grains Scene::grains()
{
  nscd::Grains g;
  g.owned = owned;
  g.ghosts = int(tag.size()) - owned;
  g.x = x.data();
  g.v = v.data();
  g.f = f.data();
  g.omega = omega.data();
  g.torque = torque.data();
  g.radius = radius.data();
  g.mass = mass.data();
  g.tag = tag.data();
  g.mask = mask.data();
  if (!type.empty()) g.type = type.data();
  if (!home.empty()) g.home = home.data();
  return g;
}

nscd::PairList Scene::pairs()
{
  first_.resize(neighbors_.size());
  for (std::size_t k = 0; k < first_.size(); ++k) first_[k] = neighbors_[k].data();  // ours, if this is a copy
  nscd::PairList p;
  p.count = int(atoms_.size());
  p.atom = atoms_.data();
  p.neighbors = counts_.data();
  p.first = first_.data();
  p.cross_pairs_twice = !newton;
  p.reach = reach;
  p.images.distance = images;
  p.just_built = just_built;
  return p;
}

const nscd::StepReport &Scene::advance(nscd::Step &step, double dt)
{
  if (atoms_.empty()) list_all_pairs();
  return step.advance(grains(), pairs(), dt);
}

Scene part_of_rank(const Scene &all, int rank, const std::function<int(int grain)> &owner)
{
  Scene part;
  part.newton = false;
  const auto at = [](const std::vector<double> &of, int i) { return Point{of[3 * i], of[3 * i + 1], of[3 * i + 2]}; };
  for (int i = 0; i < all.owned; ++i)
    if (owner(i) == rank) part.tag[part.add(at(all.x, i), all.radius[i], all.mass[i], at(all.v, i))] = all.tag[i];
  for (int i = 0; i < all.owned; ++i)
    if (owner(i) != rank) part.add_foreign_image(at(all.x, i), all.radius[i], all.tag[i], owner(i));
  return part;
}

nscd::Settings settings(const std::string &keywords)
{
  std::istringstream stream(keywords);
  std::vector<std::string> words;
  for (std::string word; stream >> word;) words.push_back(word);
  nscd::Settings settings;
  nscd::parse_keywords(settings, words);
  return settings;
}

std::string box_walls(double l, double height)
{
  std::ostringstream words;
  for (const char *normal : {"1 0 0", "0 1 0", "0 0 1"}) words << " wall plane 0 0 0 " << normal;
  for (const char *normal : {"-1 0 0", "0 -1 0", "0 0 -1"})
    words << " wall plane " << l << ' ' << l << ' ' << height << ' ' << normal;
  return words.str();
}

const nscd::Contact *find_contact(const nscd::State &state, int i, int j)
{
  for (std::size_t k = 0; k < state.table.infos.size(); ++k) {
    const auto &info = state.table.infos[k];
    if ((info.atom_i == i && info.atom_j == j) || (info.atom_i == j && info.atom_j == i))
      return &state.table.contacts[k];
  }
  return nullptr;
}

double Random::operator()(double lo, double hi) { return lo + (hi - lo) * double(engine_() >> 11) * 0x1p-53; }

// Each grain has a cell of its own, which holds the largest grain.
Scene random_scene(Random &random, int n, double l, double largest, double speed)
{
  Scene scene;
  const int cells = int(l / (2 * largest));
  const double edge = l / cells;
  for (int i = 0; i < n; ++i) {
    const double r = random(largest / 4, largest);
    const int place[3] = {i % cells, i / cells % cells, i / (cells * cells)};
    Point centre, velocity;
    for (int d = 0; d < 3; ++d) {
      centre[d] = (place[d] + 0.5) * edge + random(-1, 1) * (edge / 2 - r);
      velocity[d] = random(-speed, speed);
    }
    scene.add(centre, r, 1000 * r * r * r, velocity);
  }
  return scene;
}
