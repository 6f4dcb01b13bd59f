# SPDX-License-Identifier: GPL-2.0-or-later
# export_only(target symbol): everything else of the target stays local. Both doors contain the core, and functions
# compiled for several instruction sets are exported whatever their visibility: without this the first build of the
# core that a process loads would serve the other door too.
function(export_only target symbol)
  if(NOT CMAKE_SYSTEM_NAME STREQUAL "Linux")
    return()
  endif()
  set(script ${CMAKE_CURRENT_BINARY_DIR}/${target}.map)
  file(WRITE ${script} "{ global: ${symbol}; local: *; };\n")
  target_link_options(${target} PRIVATE -Wl,--version-script=${script})
endfunction()
