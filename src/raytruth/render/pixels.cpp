#include "raytruth/render/pixels.hpp"

#include "raytruth/signals/trilinear.hpp"

#include <tbb/blocked_range2d.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

namespace raytruth {

namespace {

void scale_lengths(Chain<3>& chain, double factor) {
  for (auto& piece : chain.pieces) {
    piece.start = piece.start * factor;
    piece.length *= factor;
  }
  chain.end = chain.end * factor;
}

}  // namespace

void for_each_pixel(const Grid& grid, const Camera& camera, const std::function<void(const Pixel&)>& work) {
  const CameraView view(camera, grid.spacing);
  const auto [width, height] = camera.size;
  tbb::enumerable_thread_specific<Chain<3>> chains;
  tbb::parallel_for(tbb::blocked_range2d<std::int64_t>(0, height, 0, width), [&](const auto& tile) {
    Chain<3>& signal = chains.local();
    for (std::int64_t row = tile.rows().begin(); row < tile.rows().end(); ++row)
      for (std::int64_t column = tile.cols().begin(); column < tile.cols().end(); ++column) {
        const PixelRay ray = view(column, row);
        trace_trilinear(grid, ray.ray, signal);
        if (ray.length_unit != 1) scale_lengths(signal, ray.length_unit);
        work({column, row, ray, signal});
      }
  });
}

}  // namespace raytruth
