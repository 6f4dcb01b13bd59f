// SPDX-License-Identifier: GPL-2.0-or-later
// nscd_lmp._core: the core for Python.
#include "arrays.hpp"
#include "base/error.hpp"
#include "external_fix.hpp"
#include "problems.hpp"
#include "scene/slides.hpp"
#include "settings/keyword.hpp"

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <cstring>

namespace nb = nanobind;
using namespace nb::literals;
using nscd::ExternalFix;
using nscd::make_array;
using nscd::State;

namespace {

int body_index(const State &s, int body) { return body < s.moving() && s.motion.bodies[body][3] > 0 ? body : -1; }

// What friction adds to the contact system.
void add_friction(nb::dict &d, const State &s, std::size_t n)
{
  const int unknowns = nscd::unknowns(s.friction.model), directions = unknowns - 1;
  std::vector<nscd::Vec4> tangents(n * directions), slips(n);
  std::vector<double> mu(n);
  nscd::with_friction(s.friction.model, [&]<class M>(M) {
    for (std::size_t k = 0; k < n; ++k) {
      const nscd::Contact &c = s.table.contacts[k];
      const auto &slide = s.table.slides<M>()[k];
      const auto pair = nscd::tangents(c.normal, s.friction.model);
      tangents[k * directions] = pair.first;
      if (directions == 2) tangents[k * directions + 1] = pair.second;
      const auto slip = nscd::velocity<M>(c, s.motion.bodies.data(), s.motion.spins.data()).t + bias(slide);
      slips[k] = M::in_space(c.normal, slip);
      mu[k] = slide.mu;
    }
  });
  d["friction"] = make_array<double>(n, 0, [&](auto k, auto) { return mu[k]; });
  d["spin_response"] = s.friction.spin_response;
  d["tangents"] = make_array<double>(n, 3 * directions,
                                     [&](auto k, auto c) { return tangents[k * directions + c / 3][c % 3]; });
  d["slip"] = make_array<double>(
      n, directions, [&](auto k, auto c) { return nscd::dot(tangents[k * directions + c], slips[k]); });
}

// The problem as a Python solver sees it; the names are those of nscd_lmp.ContactSystem.
nb::dict contact_system(const State &s, std::size_t n, std::span<const double> start)
{
  const auto &contacts = s.table.contacts;
  const auto *bodies = s.motion.bodies.data();
  nb::dict d;
  d["body_i"] = make_array<int>(n, 0, [&](auto k, auto) { return body_index(s, contacts[k].i); });
  d["body_j"] = make_array<int>(n, 0, [&](auto k, auto) { return body_index(s, contacts[k].j); });
  d["inverse_mass"] = make_array<double>(s.moving(), 0, [&](auto i, auto) { return bodies[i][3]; });
  d["normal"] = make_array<double>(n, 3, [&](auto k, auto c) { return contacts[k].normal[c]; });
  d["gap"] = make_array<double>(n, 0, [&](auto k, auto) { return s.table.infos[k].gap; });
  d["bias"] = make_array<double>(n, 0, [&](auto k, auto) { return contacts[k].bias; });
  d["velocity"] = make_array<double>(
      n, 0, [&](auto k, auto) { return nscd::normal_velocity(contacts[k], bodies) + contacts[k].bias; });
  const std::size_t unknowns = nscd::unknowns(s.friction.model), columns = unknowns == 1 ? 0 : unknowns;
  d["start"] = make_array<double>(n, columns, [&](auto k, auto c) { return start[k * unknowns + c]; });
  if (unknowns > 1) add_friction(d, s, n);
  return d;
}

// Wraps a Python callable: it gets the contact system and returns the impulses, contact by contact.
nscd::Step::CustomSolver python_solver(nb::object solve)
{
  if (solve.is_none()) return {};
  return [solve](const State &state, std::size_t contacts, std::span<double> impulses) {
    nb::gil_scoped_acquire gil;
    using Impulses = nb::ndarray<const double, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
    nb::object answer = solve(contact_system(state, contacts, impulses));
    const auto given = nb::cast<Impulses>(answer);
    const int unknowns = nscd::unknowns(state.friction.model);
    if (given.shape(0) != impulses.size())
      nscd::fail("the Python solver returned ", given.shape(0), " impulses for ", contacts, " contacts",
                 unknowns > 1 ? " of " + std::to_string(unknowns) + " unknowns" : "");
    std::copy_n(given.data(), impulses.size(), impulses.begin());
  };
}

nscd::Library make_library(const nb::dict &addresses)
{
  nscd::Library library;
  const auto load = [&](const char *name, auto &function) {
    const auto address = nb::cast<std::uintptr_t>(addresses[name]);
    function = reinterpret_cast<std::remove_reference_t<decltype(function)>>(address);
  };
  load("handle", library.handle);
  load("lammps_extract_atom", library.extract_atom);
  load("lammps_extract_global", library.extract_global);
  load("lammps_extract_setting", library.extract_setting);
  load("lammps_get_thermo", library.get_thermo);
  load("lammps_extract_box", library.extract_box);
  load("lammps_get_natoms", library.get_natoms);
  load("lammps_find_pair_neighlist", library.find_pair_neighlist);
  load("lammps_neighlist_num_elements", library.neighlist_num_elements);
  load("lammps_neighlist_element_neighbors", library.neighlist_element_neighbors);
  load("lammps_force_timeout", library.force_timeout);
  if (addresses.contains("lammps_extract_pair")) load("lammps_extract_pair", library.extract_pair);
  load("lammps_id_count", library.id_count);
  load("lammps_id_name", library.id_name);
  return library;
}

nb::bytes take_stats(ExternalFix &fix)
{
  const std::vector<nscd::StatsRow> rows = fix.take_stats();
  return nb::bytes(reinterpret_cast<const char *>(rows.data()), rows.size() * sizeof(nscd::StatsRow));
}

nb::ndarray<nb::numpy, double> contact_rows(const ExternalFix &fix)
{
  const std::size_t columns = nscd::contact_columns(fix.step().settings());
  const std::vector<double> &rows = fix.contact_rows();
  return make_array<double>(rows.size() / columns, columns, [&](auto k, auto c) { return rows[k * columns + c]; });
}

nb::ndarray<nb::numpy, double> wall_loads(const ExternalFix &fix)
{
  const std::vector<nscd::WallLoad> loads = fix.wall_loads();
  return make_array<double>(loads.size(), nscd::WallLoad{}.size(), [&](auto k, auto c) { return loads[k][c]; });
}

nb::dict traffic(const ExternalFix &fix)
{
  const nscd::Halo *halo = fix.step().halo();
  const nscd::Traffic t = halo ? halo->traffic() : nscd::Traffic{};
  nb::dict counts;
  counts["exchanges"] = t.exchanges;
  counts["messages"] = t.messages;
  counts["bytes"] = t.bytes;
  counts["reductions"] = t.reductions;
  return counts;
}

// Names and defaults of everything registered, for choice lists, tests and legends.
nb::list solver_table()
{
  nb::list table;
  for (const auto &s : nscd::solvers()) {
    nb::dict row;
    row["name"] = std::string(s.name);
    row["title"] = std::string(s.title);
    row["kind"] = std::string(s.kind);
    row["parameter"] = std::string(s.parameter);
    row["default"] = s.default_parameter;
    row["friction"] = s.friction;
    table.append(row);
  }
  return table;
}

// All that is told of a keyword; names of values are the words that it takes.
nb::list keyword_table()
{
  nb::list table;
  for (const auto &k : nscd::keywords()) {
    if (k.doc.empty()) continue;   // another spelling
    nb::dict row;
    row["name"] = std::string(k.name);
    row["kind"] = k.value.kind;
    row["choices"] = k.value.choices ? k.value.choices() : std::vector<std::string>{};
    row["range"] = k.range.text();
    row["default"] = nscd::default_of(k);
    row["value"] = k.otherwise.empty() && k.value.write ? k.value.write({}) : "";
    row["repeats"] = k.value.repeats;
    row["doc"] = std::string(k.doc);
    table.append(row);
  }
  return table;
}

nb::list law_table()
{
  nb::list table;
  for (const auto &l : nscd::schemes()) {
    nb::dict row;
    row["name"] = std::string(l.name);
    row["title"] = std::string(l.title);
    table.append(row);
  }
  return table;
}

template <std::size_t N>
nb::list names(const std::array<std::string_view, N> &columns)
{
  nb::list list;
  for (const auto name : columns) list.append(std::string(name));
  return list;
}

void bind_external_fix(nb::module_ &m)
{
  nb::class_<ExternalFix>(m, "ExternalFix")
      .def(
          "__init__",
          [](ExternalFix *self, const nb::dict &library, const std::string &id, int group_bit,
             const std::vector<std::string> &keywords, nb::object solver, nb::object ranks, nb::object find_homes) {
            nscd::Settings settings;
            nscd::parse_keywords(settings, keywords);
            new (self) ExternalFix(make_library(library), id, group_bit, settings,
                                   python_solver(std::move(solver)), std::move(ranks), std::move(find_homes));
          },
          "library"_a, "id"_a, "group_bit"_a, "keywords"_a, "solver"_a.none(),
          "ranks"_a.none(), "find_homes"_a.none())
      .def_prop_ro("callback_address", [](const ExternalFix &) { return std::uintptr_t(&ExternalFix::callback); })
      .def_prop_ro("self_address", [](const ExternalFix &fix) { return std::uintptr_t(&fix); })
      .def("invoke", &ExternalFix::invoke)
      .def("doubts", &ExternalFix::doubts)
      .def_prop_ro("crowding", [](const ExternalFix &fix) { return fix.step().crowding(); })
      .def(
          "set_listed_pairs",
          [](ExternalFix &fix, const std::string &pair_style, double cutoff, std::vector<double> shorter, bool known) {
            fix.set_listed_pairs({pair_style, cutoff, std::move(shorter), known});
          },
          "pair_style"_a, "cutoff"_a, "shorter"_a, "cutoffs_known"_a)
      .def("set_fixes", &ExternalFix::set_fixes, "held"_a, "movers"_a)
      .def("set_image_cutoff", &ExternalFix::set_image_cutoff, "cutoff"_a)
      .def_prop_ro("failed", &ExternalFix::failed)
      .def("take_remarks", &ExternalFix::take_remarks)
      .def("raise_failure", [](ExternalFix &fix) { if (auto e = fix.take_failure()) std::rethrow_exception(e); })
      .def("take_stats", &take_stats)
      .def("traffic", &traffic)
      .def("contact_rows", &contact_rows)
      .def("wall_loads", &wall_loads)
      .def("describe", [](const ExternalFix &fix) { return nscd::describe(fix.step()); });
}

}    // namespace

NB_MODULE(_core, m)
{
  m.doc() = "Compiled core of nscd_lmp.";
  // A LAMMPS object that lives until the interpreter ends keeps its fix: no leak.
  nb::set_leak_warnings(false);
  nb::exception<nscd::Error>(m, "NscdError", PyExc_RuntimeError);
  bind_external_fix(m);
  nscd::bind_problems(m);
  m.def("solvers", &solver_table,
        "Solvers in legend order: name, title, kind, parameter, default (multiple of 1/W_nn), friction.");
  m.def("laws", &law_table, "Contact laws: name, title.");
  m.def("keywords", &keyword_table,
        "Keywords of fix nscd, in the order of the docs: name, kind, choices, range, default (as docs have it), value "
        "(the default as it is read, or empty), repeats, doc.");
  nb::list parts;
  for (const auto &part : nscd::material_parts) parts.append(std::string(part.name));
  m.attr("MATERIAL_PARTS") = parts;
  m.attr("REPORT_COLUMNS") = names(nscd::report_column_names);
  m.attr("TOTALS_COLUMNS") = names(nscd::totals_column_names);
  m.attr("CONTACT_COLUMNS") = names(nscd::contact_column_names);
}
