# cmake -D SOURCE= -D HEADER= -D "TEXTS=NAME=FILE+FILE;NAME=FILE" -D OUTPUT= -P embed.cmake
# Writes what HEADER declares: for every NAME a string with the texts of its files, one behind the other.

set(strings "")
foreach(text IN LISTS TEXTS)
  string(REGEX MATCH "^([^=]+)=(.*)$" found ${text})
  set(name ${CMAKE_MATCH_1})
  string(REPLACE + ";" files ${CMAKE_MATCH_2})
  set(content "")
  foreach(file IN LISTS files)
    file(READ ${SOURCE}/${file} part)
    string(APPEND content "${part}")
  endforeach()
  string(APPEND strings "const char* const ${name} = R\"embedded(${content})embedded\";\n\n")
endforeach()
file(WRITE ${OUTPUT} "#include \"${HEADER}\"\n\nnamespace raytruth {\n\n${strings}}  // namespace raytruth\n")
