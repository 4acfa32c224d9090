// The choice among kernels that are compiled for several instruction sets (NAME_baseline, NAME_avx2), all of which give
// the same bits.
#pragma once

/// The fastest that this machine runs. A macro, since off x86 there is no NAME_avx2 to be named.
#ifdef GAUSSMAP_X86
#define GAUSSMAP_FASTEST(name) (__builtin_cpu_supports("avx2") ? name##_avx2 : name##_baseline)
#else
#define GAUSSMAP_FASTEST(name) name##_baseline
#endif
