// SPDX-License-Identifier: GPL-2.0-or-later
// nscdplugin.so, what LAMMPS loads: checks LAMMPS' version, then loads fix nscd from fix_nscd.so beside it.
//
// C++ classes of LAMMPS change between releases, so fix nscd serves only the release that it was compiled for, and
// LAMMPS opens plugins with all symbols bound at once: in another release that fails before any code of a plugin runs.
// Therefore this library needs LAMMPS' C interface alone, of which the two functions for the message may be missing.

#include "progress.hpp"

#include <dlfcn.h>

#include <cstdio>
#include <string>

extern "C" {
int lammps_version(void *handle);
[[gnu::weak]] int lammps_extract_setting(void *handle, const char *keyword);
[[gnu::weak]] void lammps_error(void *handle, int error_type, const char *error_text);
}

// Fixes nscd find it here, as LAMMPS opens plugins with their symbols visible to all.
nscd::Progress nscd_progress;

namespace {

using Register = void (*)(void *lmp, void *plugin, void *register_style);
constexpr int lammps_warning = 0;    // LMP_ERROR_WARNING of library.h

void warn(void *lmp, const std::string &reason)
{
  if (lammps_extract_setting && lammps_extract_setting(lmp, "world_rank") > 0) return;
  const std::string text = "fix nscd is not available: " + reason +
      "; reinstall nscd_lmp with the matching lammps package, or use nscd_lmp.attach, which works with any";
  if (lammps_error)
    lammps_error(lmp, lammps_warning, text.c_str());
  else
    std::fprintf(stderr, "WARNING: %s\n", text.c_str());
}

std::string fix_library_path()
{
  Dl_info here;
  dladdr(reinterpret_cast<void *>(&warn), &here);
  const std::string path = here.dli_fname;
  return path.substr(0, path.rfind('/') + 1) + "fix_nscd.so";
}

std::string last_error()
{
  const char *text = dlerror();
  return text ? text : "unknown error";
}

}    // namespace

extern "C" [[gnu::visibility("default")]] void lammpsplugin_init(void *lmp, void *plugin, void *register_style)
{
  const int running = lammps_version(lmp);
  if (running != NSCD_LAMMPS_VERSION)
    return warn(lmp, "it was built for LAMMPS " + std::to_string(NSCD_LAMMPS_VERSION) + " and this is LAMMPS " +
                         std::to_string(running));
  // Never closed: `plugin unload` closes this library, not the code of a fix that may still be in use.
  void *library = dlopen(fix_library_path().c_str(), RTLD_NOW | RTLD_LOCAL);
  if (!library) return warn(lmp, last_error());
  const auto register_fix = reinterpret_cast<Register>(dlsym(library, "nscd_register_fix"));
  if (!register_fix) return warn(lmp, last_error());
  register_fix(lmp, plugin, register_style);
}
