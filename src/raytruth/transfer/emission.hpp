#pragma once

namespace raytruth {

/// What a transfer function's colour c(s) means: how much light a unit of length sends out.
enum class Emission {
  associated,  ///< q = tau(s) c(s): the medium glows as much as it absorbs (El Hajjar 2008, eq. 1)
  plain,       ///< q = c(s) (Guetat 2010, eq. 3)
};

}  // namespace raytruth
