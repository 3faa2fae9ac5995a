#pragma once

#include "raytruth/cells/tetrahedral_mesh.hpp"
#include "raytruth/core/chain.hpp"
#include "raytruth/signals/precise_chain.hpp"
#include "raytruth/signals/ray.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

namespace raytruth {

/// A stretch of a ray without gaps in it.
struct MeshPart {
  std::size_t first_piece = 0;  ///< of the signal; it ends where the next part begins
  DoubleDouble from;            ///< t, counted from the first face that the ray meets, gaps included
  DoubleDouble to;
};

/// What a ray meets of a mesh.
struct MeshRay {
  /// A linear piece for each cell, of degree 3 in form. Gaps between parts are left out: there is nothing in them.
  PreciseChain<3> signal;
  std::vector<MeshPart> parts;
  std::vector<std::uint32_t> cells;  ///< of each piece

  /// The signal in binary64, and how far it is from the one meant.
  [[nodiscard]] std::pair<Chain<3>, SignalError> chain() const;
};

/// The scalar along rays through tetrahedra, a walk from face to face: where a ray leaves a cell through a face, an
/// edge or a point, the next cell is the one that it enters through just that. Which these are is decided by the signs
/// of determinants of the numbers of mesh and ray, exactly, so that rays in faces, along edges and through points have
/// neither gap nor overlap; a ray in a face that two cells share is the first one's. The crossing of a face is in 106
/// bits, or, where a ray next to grazes it, a rational number, and its error is in the signal's.
class TetrahedralField {
 public:
  /// `mesh`: completed (`complete`), or of `split_grid`.
  explicit TetrahedralField(TetrahedralMesh mesh);
  ~TetrahedralField();
  TetrahedralField(const TetrahedralField&) = delete;
  TetrahedralField& operator=(const TetrahedralField&) = delete;
  TetrahedralField(TetrahedralField&&) noexcept;
  TetrahedralField& operator=(TetrahedralField&&) noexcept;

  [[nodiscard]] const TetrahedralMesh& mesh() const { return mesh_; }
  /// The least and greatest coordinates of its cells.
  [[nodiscard]] std::array<std::array<double, 3>, 2> box() const;

  /// The ray from its origin on, in coordinates of the mesh; its length counts from the first face, or from the origin
  /// if that is inside. Throws InputError for a direction that is zero or not finite, origins beyond 2^250, and, with
  /// the cells' numbers, where cells overlap on the ray.
  [[nodiscard]] MeshRay trace(const Ray& ray) const;

 private:
  struct Tree;

  TetrahedralMesh mesh_;
  std::unique_ptr<const Tree> tree_;
};

}  // namespace raytruth
