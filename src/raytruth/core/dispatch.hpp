#pragma once

/// Put before a function whose loops are worth wider registers: the compiler then makes one version for every level of
/// x86-64 and the program takes the best one that the processor has. With -ffp-contract=off all of them give the same
/// bits. Everything the function calls is made part of it, so that it is compiled for that level too.
#if defined(__GNUC__) && !defined(__clang__) && defined(__x86_64__) && defined(__linux__) && \
    !defined(__SANITIZE_ADDRESS__)
#define RAYTRUTH_DISPATCH [[gnu::target_clones("default", "arch=x86-64-v3", "arch=x86-64-v4"), gnu::flatten]]
#else
#define RAYTRUTH_DISPATCH
#endif
