#pragma once

// Stands for oneTBB's header of this name: a page has one thread.

namespace tbb {

template <class Index, class Body>
void parallel_for(Index first, Index last, const Body& body) {
  for (Index i = first; i < last; ++i) body(i);
}

}  // namespace tbb
