// Who loads the module knows nothing of raytruth.

#include <cmath>

extern "C" double certified_opacity(double extinction);

int main() { return std::abs(certified_opacity(2) - (1 - std::exp(-2))) < 1e-12 ? 0 : 1; }
