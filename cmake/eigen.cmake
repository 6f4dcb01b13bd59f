# SPDX-License-Identifier: GPL-2.0-or-later
# Eigen, for sparse factorisations: headers alone, from the system or from PyPI's cmeel-eigen, which pyproject.toml asks
# for. Sets the imported target nscd_eigen.
find_package(Eigen3 QUIET NO_MODULE)
if(TARGET Eigen3::Eigen)
  get_target_property(eigen_include Eigen3::Eigen INTERFACE_INCLUDE_DIRECTORIES)
else()
  find_package(Python 3.10 REQUIRED COMPONENTS Interpreter)
  execute_process(
    COMMAND ${Python_EXECUTABLE} -c "
import importlib.metadata as m
print(next(f for f in m.files('cmeel-eigen') if f.match('include/eigen3/Eigen/Core')).locate().resolve().parent.parent)"
    OUTPUT_STRIP_TRAILING_WHITESPACE OUTPUT_VARIABLE eigen_include ERROR_QUIET RESULT_VARIABLE missing)
  if(missing)
    message(FATAL_ERROR "Eigen not found: pip install cmeel-eigen, or install Eigen 3")
  endif()
endif()
add_library(nscd_eigen INTERFACE)
target_include_directories(nscd_eigen SYSTEM INTERFACE ${eigen_include})
target_compile_definitions(nscd_eigen INTERFACE EIGEN_MPL2_ONLY)
