// SPDX-License-Identifier: GPL-2.0-or-later
// Marks loops that are compiled twice, for any x86-64 and for AVX2, and chosen when the program is loaded.
//
// AVX2 holds a body's four doubles in one register: on a bed of 1000 grains 5.5 -> 4.8 ns a contact and sweep, and the
// rest of a step 187 -> 131 us, both compiled and run side by side. Fused multiply-add is left out
// on purpose: without it both versions give the same bits, on every machine. Clang has no clones of templates: it
// compiles for any x86-64 alone, to the same bits again.
//
// Such a function must not raise errors. GCC takes it for one that never throws, so an exception that leaves it ends
// the program wherever its caller has something to destroy. It returns what is wrong, and its caller raises.
#pragma once

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)
#define NSCD_HOT __attribute__((target_clones("avx2", "default")))
#else
#define NSCD_HOT
#endif

// For what a hot loop calls: it must be compiled with the loop, for the same instruction set.
#define NSCD_INLINE inline __attribute__((always_inline))
// The same for a lambda, after its parameters.
#define NSCD_INLINED __attribute__((always_inline))
