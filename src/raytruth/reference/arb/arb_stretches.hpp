#pragma once

#include "raytruth/core/vector3.hpp"
#include "raytruth/reference/arb/arb_pieces.hpp"
#include "raytruth/transfer/gaussian_transfer.hpp"
#include "raytruth/transfer/piecewise_linear.hpp"

#include <array>
#include <functional>
#include <optional>
#include <vector>

namespace raytruth::arb {

using Color = std::array<Ball, 3>;

/// A stretch of a ray on which polynomials in x on [0, 1] enclose what the transfer function says of the signal: the
/// extinction, and the colour as color + weight * color_change.
struct BallStretch {
  Ball length;
  Polynomial extinction;
  Polynomial weight;
  Color color;
  Color color_change;
  std::optional<Ball> depth = {};  ///< the optical depth where no more than that is known of the extinction
};

/// A depth behind which there is nothing: the infinite one of what is opaque.
inline constexpr double opaque_depth = 0x1p20;

using Visit = std::function<void(const BallStretch&)>;

/// A piecewise linear transfer function. A piece is cut where its signal meets the points: the crossings are isolated
/// by halving until the signal is monotone, then by Newton's method on intervals. A crossing lies somewhere in a gap of
/// some 2^-100 of the piece, and so does a contact that no arithmetic can decide in some 2^-60: on those stretches all
/// values of the transfer function that the signal may meet are enclosed by one ball.
///
/// Where the opacity a is linear, -ln(1 - a) is made into Taylor's polynomials, on parts that are halved towards an a
/// of
/// 1. What is left there, 2^-64 of a piece, is enclosed: the mean of ln |p| of a polynomial p of degree n is at least
/// ln(max |p|) - 1.2785 n.
class PointsCut {
 public:
  explicit PointsCut(const PiecewiseLinear& transfer);

  void operator()(const BallPiece& piece, const Visit& visit) const;
  [[nodiscard]] Ball largest_color(const Ball& largest_signal) const;

 private:
  /// Linear from `begin` to `end`; both values are alike on the half-lines beyond the points.
  struct Interval {
    Optics begin;
    Optics end;
    double opacity_begin = 0;  ///< where the opacity is linear
    double opacity_end = 0;

    [[nodiscard]] bool is_opaque() const { return opacity_begin == 1 && opacity_end == 1; }
  };
  /// x from begin to end; without an interval: it may be any that the signal meets.
  struct Part {
    Ball begin;
    Ball end;
    std::optional<std::size_t> interval;
  };

  [[nodiscard]] std::size_t points_below(const Ball& s) const;
  [[nodiscard]] std::optional<std::size_t> common_interval(const std::vector<Ball>& control) const;
  void find_parts(const BallPiece& piece, const Ball& begin, const Ball& end, const std::vector<Ball>& control,
                  std::vector<Part>& parts) const;
  void cut_monotone(const BallPiece& piece, const Ball& begin, const Ball& end, const Ball& first, const Ball& last,
                    std::vector<Part>& parts) const;
  void visit_opacity(std::size_t interval, const BallPiece& piece, const Ball& begin, const Ball& end,
                     const Visit& visit) const;
  void visit_opaque(std::size_t interval, const BallPiece& piece, const Ball& begin, const Ball& end,
                    const Visit& visit) const;
  void visit_part(const std::optional<std::size_t>& interval, const BallPiece& piece, const Ball& begin,
                  const Ball& end, const Visit& visit) const;
  [[nodiscard]] BallStretch stretch_in(std::size_t interval, const BallPiece& piece, const Ball& begin,
                                       const Ball& end) const;
  [[nodiscard]] BallStretch stretch_across(const BallPiece& piece, const Ball& begin, const Ball& end) const;

  std::vector<double> points_;       ///< ascending, each once
  std::vector<Interval> intervals_;  ///< interval i ends at point i
  double unit_length_ = 0;           ///< of opacities; 0: the extinction is linear
};

/// A Gaussian transfer function: Taylor's polynomials of the extinction.
class GaussianCut {
 public:
  explicit GaussianCut(const GaussianTransfer& transfer);

  void operator()(const BallPiece& piece, const Visit& visit) const { cut(piece, 0.0, piece.end, visit); }
  [[nodiscard]] Ball largest_color(const Ball& largest_signal) const;

 private:
  void cut(const BallPiece& piece, const Ball& begin, const Ball& end, const Visit& visit) const;

  GaussianTransfer transfer_;
};

}  // namespace raytruth::arb
