# cmake -D NAME= -D HEADER= -D INPUTS= -D OUTPUT= -P embed.cmake
# Writes what HEADER declares: the texts of INPUTS, one behind the other, as the string NAME.

set(text "")
foreach(input IN LISTS INPUTS)
  file(READ ${input} part)
  string(APPEND text "${part}")
endforeach()
file(WRITE ${OUTPUT} "#include \"${HEADER}\"

namespace raytruth {

const char* const ${NAME} = R\"embedded(${text})embedded\";

}  // namespace raytruth
")
