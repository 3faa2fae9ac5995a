#include "raytruth/reference/arb/exact_cut.hpp"

namespace raytruth::arb {

// Stands for the one that uses Arb: the piece in one part that may be in any interval. The integral then bounds what
// crossings in binary64 are off by, as it does where there are no jumps; so the radius holds, but at a high jump of the
// transfer function it is larger than the program's.
template <int Degree>
std::vector<CutPart> exact_cut(const PrecisePiece<Degree>& /*piece*/, const std::vector<double>& knots) {
  return {{.begin = 0.0, .end = 1.0, .width = 1.0, .first_interval = 0, .last_interval = knots.size()}};
}

template std::vector<CutPart> exact_cut(const PrecisePiece<3>&, const std::vector<double>&);
template std::vector<CutPart> exact_cut(const PrecisePiece<9>&, const std::vector<double>&);

}  // namespace raytruth::arb
