# cmake -D INPUT= -D OUTPUT= -P plot_script.cmake
# Writes what src/study/plot_script.hpp declares: the text of INPUT as a string.

file(READ ${INPUT} text)
file(WRITE ${OUTPUT} "#include \"study/plot_script.hpp\"

namespace raytruth {

const char* const plot_script = R\"plot_script(${text})plot_script\";

}  // namespace raytruth
")
