#include "report.hpp"

#include <sstream>

namespace nscd {

double report_column(const StepReport &r, int column)
{
  switch (column) {
    case 0: return r.contacts;
    case 1: return r.iterations;
    case 2: return r.criterion.total();
    case 3: return r.criterion.motion;
    case 4: return r.criterion.bipotential;
    case 5: return r.criterion.penetration;
    case 6: return r.criterion.relative;
    case 7: return r.largest_overlap;
    case 8: return r.dissipated;
    case 9: return r.largest_overlap_ratio;
    case 10: return double(r.unconverged);
  }
  return 0;
}

void fill_contact_rows(const State &s, double *row)
{
  for (std::size_t k = 0; k < s.contacts.size(); ++k, row += contact_columns) {
    const Contact &c = s.contacts[k];
    const ContactInfo &info = s.infos[k];
    const Sphere &a = s.spheres[info.atom_i];
    const Vec4 centre = a.centre + s.displacement[c.i];
    const Vec4 point = centre - c.normal * (a.radius + 0.5 * info.gap);
    row[0] = s.grains.tag[info.atom_i];
    row[1] = info.atom_j >= 0 ? s.grains.tag[info.atom_j] : info.atom_j;
    for (int d = 0; d < 3; ++d) {
      row[2 + d] = point[d];
      row[5 + d] = c.normal[d];
    }
    row[8] = info.gap;
    row[9] = c.impulse;
  }
}

static std::string describe_solver(const Settings &s)
{
  const SolverEntry &solver = find_solver(s.solver);
  std::ostringstream text;
  text << "NLGS with " << solver.title << " (" << solver.parameter << " = " << solver_parameter(s, solver) << "/W_nn)";
  return text.str();
}

std::string describe(const Step &step)
{
  const Settings &s = step.settings();
  std::ostringstream text;
  text << "law " << s.law << ", " << (step.has_custom_solver() ? "a solver handed in" : describe_solver(s)) << ", tol "
       << s.tol << ", " << s.walls.size() << (s.walls.size() == 1 ? " wall" : " walls")
       << "; frictionless: 1 unknown per contact, no spins; ";
  if (s.restitution > 0) text << "impacts with restitution " << s.restitution;
  else text << "no restitution term";
  text << "; one rank: no exchange";
  return text.str();
}

}    // namespace nscd
