# Writes the text of all DIR/*.lcm as one string constant to OUT.
file(GLOB files ${DIR}/*.lcm)
list(SORT files)
set(body "")
foreach(file ${files})
  file(READ ${file} text)
  string(APPEND body "    R\"lcm(${text})lcm\"\n")
endforeach()
file(WRITE ${OUT} "#include \"${DIR}/definitions.hpp\"\n\nnamespace hairpin {\nconst char* const kMessageDefinitions =\n${body}    ;\n}\n")
