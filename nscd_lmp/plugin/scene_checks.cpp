// SPDX-License-Identifier: GPL-2.0-or-later
#include "scene_checks.hpp"

#include "region_wall.hpp"

#include "base/error.hpp"
#include "scene/list/bonded.hpp"

#include <atom.h>
#include <comm.h>
#include <compute.h>
#include <domain.h>
#include <error.h>
#include <fix.h>
#include <force.h>
#include <group.h>
#include <input.h>
#include <modify.h>
#include <neighbor.h>
#include <pair.h>
#include <update.h>
#include <variable.h>

#include <algorithm>
#include <cstring>
#include <iterator>

using namespace LAMMPS_NS;

namespace {

template <std::size_t N>
bool begins_with_one_of(const std::string &style, const char *const (&beginnings)[N])
{
  return std::any_of(std::begin(beginnings), std::end(beginnings),
                     [&style](const char *beginning) { return style.rfind(beginning, 0) == 0; });
}

}    // namespace

void SceneChecks::require_spheres(bool frictional) const
{
  const std::pair<int, const char *> shapes[] = {{atom->body_flag, "body"},
                                                 {atom->line_flag, "line"},
                                                 {atom->tri_flag, "tri"},
                                                 {atom->ellipsoid_flag, "ellipsoid"}};
  for (const auto &[there, name] : shapes)
    if (there)
      nscd::fail("atom_style ", name, " is not of spheres, and grains would be taken for some: use atom_style sphere");
  if (!atom->radius_flag) nscd::fail("atoms have no radius: use atom_style sphere");
  if (frictional && !atom->omega_flag)
    nscd::fail("friction turns grains, but atoms have no angular velocity: use atom_style sphere, or leave friction ",
               "out");
  if (!atom->tag_enable) nscd::fail("atoms have no IDs: use atom_modify id yes");
  if (utils::strmatch(update->integrate_style, "^respa")) nscd::fail("it needs run_style verlet");
}

void SceneChecks::require_sole_integrator()
{
  for (Fix *other : modify->get_fix_list()) {
    if (other == fix_ || !other->time_integrate) continue;
    double tag = 0;
    for (int i = 0; i < atom->nlocal; ++i)
      if ((atom->mask[i] & fix_->groupbit) && (atom->mask[i] & other->groupbit))
        tag = std::max<double>(tag, atom->tag[i]);
    ranks_.max({&tag, 1});
    if (tag > 0)
      nscd::fail("atom ", tagint(tag), " is moved by fix ", other->id, " (style ", other->style,
                 ") too: remove that fix or give the two disjoint groups");
  }
}

void SceneChecks::tell_of_other_fixes_nscd() const
{
  for (Fix *other : modify->get_fix_list())
    if (other != fix_ && utils::strmatch(other->style, "^nscd") && comm->me == 0)
      error->warning(FLERR,
                     "Fix nscd {}: fix {} is a second fix nscd, and the grains of one are infinitely heavy to the "
                     "other: where they can meet, use one fix for the union of their groups",
                     fix_->id, other->id);
}

// What a script that is converted to this fix is likely to have left. Once.
void SceneChecks::tell_of_soft_contacts()
{
  Pair *pair = force->pair_match("^gran", 0);
  if (!pair || told_of_soft_contacts_) return;
  told_of_soft_contacts_ = true;
  if (comm->me == 0)
    error->warning(FLERR,
                   "Fix nscd {}: pair style {} gives grains the forces of soft contacts beside their rigid ones: use "
                   "pair_style nscd in its place, and `pair_coeff I J friction ... restitution ...`",
                   fix_->id, force->pair_match_ptr(pair));
}

// Smooth forces act from the start of a step on, as they are there: what springs give back they give too long.
void SceneChecks::tell_of_soft_walls()
{
  for (Fix *other : modify->get_fix_list()) {
    if (!utils::strmatch(other->style, "^wall/gran") || soft_walls_told_of_.count(other->id)) continue;
    soft_walls_told_of_.insert(other->id);
    if (comm->me == 0)
      error->warning(FLERR,
                     "Fix nscd {}: fix {} (style {}) is a soft wall, whose springs act a step late: grains leave it "
                     "exp(2.5 dt/T) times as fast as they should, T = pi sqrt(m/kn) being its contact time, so keep "
                     "the timestep dt below T/5; fix wall/nscd is a rigid wall, for any timestep",
                     fix_->id, other->id, other->style);
  }
}

void SceneChecks::tell_of_forgotten_walls(const nscd::Settings &settings) const
{
  const bool of_scene = domain->get_region_by_id("nscd_scene") && input->variable->find("nscd_walls") >= 0;
  const bool has_others = !modify->get_fix_by_style("^wall/").empty();
  if (of_scene && settings.walls.empty() && !has_others && comm->me == 0)
    error->warning(FLERR,
                   "Fix nscd {} has no walls, and the scene was made with some: append ${{nscd_walls}} to its line, "
                   "if they are to hold grains",
                   fix_->id);
}

// Whether an atom that this fix moves is in the other's group.
bool SceneChecks::moves_atoms_of(const Fix &other, int held)
{
  const int both = fix_->groupbit | other.groupbit;
  double there = 0;
  for (int i = 0; i < atom->nlocal; ++i)
    if ((atom->mask[i] & both) == both && !(atom->mask[i] & held)) there = 1;
  ranks_.max({&there, 1});
  return there > 0;
}

// Set a force or a part of it: LAMMPS' own contacts are forces too, and grains are held and guided by these fixes.
// What they set the force to, LAMMPS does not tell, and as a load it is right: so they are no errors.
void SceneChecks::tell_of_force_holders()
{
  const int held = held_groups();   // not in the loop: LAMMPS makes the list of fixes anew for each who asks
  for (Fix *other : modify->get_fix_list()) {
    if (!begins_with_one_of(other->style, {"setforce", "lineforce", "planeforce", "aveforce"}) ||
        holders_told_of_.count(other->id) || !moves_atoms_of(*other, held))
      continue;
    holders_told_of_.insert(other->id);
    if (comm->me == 0)
      error->warning(FLERR,
                     "Fix nscd {}: fix {} (style {}) sets forces, and impulses of contacts, which are none, move its "
                     "grains all the same: to hold grains, leave them out of the group of fix {}, or use fix freeze; "
                     "to keep them in a plane, use dimension 2",
                     fix_->id, other->id, other->style, fix_->id);
  }
}

// Rerun sets up frame after frame and takes no step: what this fix gives out would be that of no frame.
void SceneChecks::require_steps() const
{
  if (input->command && strcmp(input->command, "rerun") == 0)
    nscd::fail("rerun reads frames and takes no steps, so there are no contacts: unfix ", fix_->id, " before rerun");
}

void SceneChecks::require_walls_repeat(const nscd::Settings &settings)
{
  const bool tilted = domain->triclinic;
  nscd::BoxEdges box{{{domain->xprd, 0, 0},
                      {tilted ? domain->xy : 0, domain->yprd, 0},
                      {tilted ? domain->xz : 0, tilted ? domain->yz : 0, domain->zprd}},
                     {domain->xperiodic != 0, domain->yperiodic != 0, domain->zperiodic && domain->dimension == 3}};
  std::copy_n(domain->boxlo, 3, box.low);
  for (int i = 0; i < atom->nlocal; ++i) box.radius = std::max(box.radius, atom->radius[i]);
  ranks_.max({&box.radius, 1});
  for (const nscd::Wall &wall : settings.walls) {
    try {
      nscd::require_walls_repeat({&wall, 1}, box);
    } catch (const nscd::Error &unlike) {
      // LAMMPS' users have regions that reach beyond a periodic box where no grain gets to.
      if (!dynamic_cast<const RegionWall *>(wall.shape.get())) throw;
      const bool is_new = walls_told_of_.insert(wall.name).second;
      if (is_new && comm->me == 0) error->warning(FLERR, "Fix nscd {}: {}", fix_->id, unlike.what());
    }
  }
}

bool SceneChecks::lists_pairs(int bonds) const { return neighbor->special_flag[bonds] != 0; }

void SceneChecks::require_bonds_listed(const nscd::Grains &grains)
{
  if (atom->molecular == Atom::ATOMIC) return;
  const nscd::Bonded bonded{atom->nspecial, {lists_pairs(1), lists_pairs(2), lists_pairs(3)}};
  if (bonded.all_listed()) return;
  double tag = nscd::find_unlisted(bonded, grains);
  // Templates keep the partners of their atoms to themselves.
  if (atom->molecular == Atom::TEMPLATE && atom->nbonds > 0 && atom->nlocal > 0) tag = atom->tag[0];
  ranks_.max({&tag, 1});
  nscd::require_listed(tagint(tag));
}

void SceneChecks::require_future_bonds_listed() const
{
  if (atom->molecular == Atom::ATOMIC || lists_pairs(1)) return;
  for (Fix *other : modify->get_fix_list())
    if (begins_with_one_of(other->style, {"bond/create", "bond/react"}))
      nscd::fail("fix ", other->id, " (style ", other->style, ") makes bonds, and special_bonds leaves bonded pairs ",
                 "out of the neighbor list, so that they would pass through each other: use `special_bonds lj 1 1 1`");
}

// Whether pairs of the first kind with the second can be contacts: both are there, and one of them moves.
template <class First, class Second>
bool SceneChecks::can_meet(const nscd::Grains &grains, First first, Second second)
{
  double there[4] = {};   // of the first, of the second, and those of them that move
  for (int i = 0; i < grains.owned; ++i) {
    const bool moves = grains.moves(i);
    if (first(i)) there[0] = 1, there[2] = std::max<double>(there[2], moves);
    if (second(i)) there[1] = 1, there[3] = std::max<double>(there[3], moves);
  }
  ranks_.max(there);
  return (there[0] > 0 && there[3] > 0) || (there[1] > 0 && there[2] > 0);
}

std::string SceneChecks::exclusions(const nscd::Grains &grains)
{
  if (!neighbor->exclude) return "";
  std::string text;
  const auto add = [&text](const std::string &pairs) { text += (text.empty() ? "" : ", ") + pairs; };
  const auto of_type = [this](int type) { return [this, type](int i) { return atom->type[i] == type; }; };
  const auto of_group = [this](int number) {
    return [this, bit = group->bitmask[number]](int i) { return (atom->mask[i] & bit) != 0; };
  };
  for (int k = 0; k < neighbor->nex_type; ++k)
    if (can_meet(grains, of_type(neighbor->ex1_type[k]), of_type(neighbor->ex2_type[k])))
      add(fmt::format("of types {} and {}", neighbor->ex1_type[k], neighbor->ex2_type[k]));
  for (int k = 0; k < neighbor->nex_group; ++k)
    if (can_meet(grains, of_group(neighbor->ex1_group[k]), of_group(neighbor->ex2_group[k])))
      add(fmt::format("of groups {} and {}", group->names[neighbor->ex1_group[k]],
                      group->names[neighbor->ex2_group[k]]));
  for (int k = 0; k < neighbor->nex_mol; ++k)
    if (can_meet(grains, of_group(neighbor->ex_mol_group[k]), of_group(neighbor->ex_mol_group[k])))
      add(fmt::format("of {} in group {}", neighbor->ex_mol_intra[k] ? "one molecule" : "two molecules",
                      group->names[neighbor->ex_mol_group[k]]));
  if (text.empty()) return "";
  return "pairs " + text + " are never contacts: neigh_modify exclude leaves them out of the neighbor list";
}

int SceneChecks::held_groups() const
{
  int bits = 0;
  for (Fix *other : modify->get_fix_list())
    if (strcmp(other->style, "freeze") == 0) bits |= other->groupbit;
  return bits;
}

// LAMMPS calls fixes in the order of its list, and every other integrator moves its atoms ahead of forces.
SceneChecks::OtherGroups SceneChecks::groups_of_other_fixes_nscd() const
{
  OtherGroups bits;
  bool later = false;
  for (Fix *other : modify->get_fix_list()) {
    if (other == fix_)
      later = true;
    else if (utils::strmatch(other->style, "^nscd"))
      (later ? bits.later : bits.earlier) |= other->groupbit;
  }
  return bits;
}

// LAMMPS does not tell what a compute reads, and evaluates computes when fixes and variables ask for them. Its own
// three, thermo_temp, thermo_press and thermo_pe, read no fix.
bool SceneChecks::rows_may_be_read() const
{
  for (Fix *other : modify->get_fix_list())
    if (begins_with_one_of(other->style, {"ave/", "vector", "external", "python/"})) return true;
  for (Compute *compute : modify->get_compute_list())
    if (!begins_with_one_of(compute->id, {"thermo_"})) return true;
  return false;
}
