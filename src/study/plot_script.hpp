#pragma once

namespace raytruth {

/// The text of plot.py, which draws results with matplotlib; src/cmake/embed.cmake puts it into the program.
extern const char* const plot_script;

}  // namespace raytruth
