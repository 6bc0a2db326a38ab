# optixc_add_pipeline(NAME SOURCES shader.py [OPTIONS --math fast ...] [INCLUDE_DIRECTORIES dir ...])
#
# Compiles a shader file to NAME.so, NAME.h (structs of parameters and records) and NAME.json in the build folder, anew when the
# shader, a helper file that it imports or the options change. A target that links to NAME can include "NAME.h", finds the path of
# the shared object in the macro NAME_PATH (upper case) for oxrtPipelineLoad, and links to liboxrt.
function(optixc_add_pipeline name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "SOURCES;OPTIONS;INCLUDE_DIRECTORIES")
  if(arg_UNPARSED_ARGUMENTS)
    message(FATAL_ERROR "optixc_add_pipeline: unknown arguments ${arg_UNPARSED_ARGUMENTS}")
  endif()
  list(LENGTH arg_SOURCES count)
  if(NOT count EQUAL 1)
    message(FATAL_ERROR "optixc_add_pipeline: SOURCES takes one shader file, which may import others; got ${count}")
  endif()
  get_filename_component(source "${arg_SOURCES}" ABSOLUTE)
  set(folder "${CMAKE_CURRENT_BINARY_DIR}/${name}.optixc")
  set(stem "${folder}/${name}")
  set(includes "")
  foreach(directory IN LISTS arg_INCLUDE_DIRECTORIES)
    get_filename_component(directory "${directory}" ABSOLUTE)
    list(APPEND includes -I "${directory}")
  endforeach()

  add_custom_command(
    OUTPUT "${stem}.so" "${stem}.h" "${stem}.json"
    COMMAND "${CMAKE_COMMAND}" -E make_directory "${folder}"
    COMMAND "${OPTIXC_EXECUTABLE}" "${source}" -o "${stem}" --depfile "${stem}.d" ${includes} ${arg_OPTIONS}
    DEPENDS "${source}" "${OPTIXC_EXECUTABLE}"
    DEPFILE "${stem}.d"
    COMMENT "Compiling shader ${arg_SOURCES}"
    VERBATIM)
  add_custom_target(${name}_optixc DEPENDS "${stem}.so" "${stem}.h" "${stem}.json")

  add_library(${name} INTERFACE)
  add_dependencies(${name} ${name}_optixc)
  string(TOUPPER "${name}" upper)
  string(MAKE_C_IDENTIFIER "${upper}" upper)
  target_include_directories(${name} INTERFACE "${folder}")
  target_compile_definitions(${name} INTERFACE "${upper}_PATH=\"${stem}.so\"")
  target_link_libraries(${name} INTERFACE optixc::oxrt)
endfunction()
