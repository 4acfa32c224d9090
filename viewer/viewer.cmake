# The viewer's page, built by npm and put into the library. Without node, or where its packages cannot be had, the library
# is built without: page.h then says what is missing.
set(viewer_folder ${CMAKE_CURRENT_LIST_DIR})
find_program(GAUSSMAP_NODE node)
find_program(GAUSSMAP_NPM npm)
set(viewer_source src/viewer_page_missing.cpp)
if(GAUSSMAP_NODE AND GAUSSMAP_NPM)
  # npm writes this file last: older than the lock, or not there, means that there is something to install.
  set(installed ${viewer_folder}/node_modules/.package-lock.json)
  if(${viewer_folder}/package-lock.json IS_NEWER_THAN ${installed})
    message(STATUS "Installing the packages of the viewer")
    execute_process(COMMAND ${GAUSSMAP_NPM} ci --no-audit --no-fund --loglevel=error WORKING_DIRECTORY ${viewer_folder}
      RESULT_VARIABLE status OUTPUT_QUIET ERROR_VARIABLE complaint)
    if(status EQUAL 0)
      file(TOUCH ${installed})
    else()
      message(WARNING "Built without the viewer: npm ci failed in ${viewer_folder}:\n${complaint}")
    endif()
  endif()
  if(EXISTS ${installed} AND NOT EMSCRIPTEN)  # the page in the browser draws by itself
    set(viewer_source ${PROJECT_BINARY_DIR}/viewer/viewer_page.cpp)
    file(GLOB_RECURSE viewer_inputs CONFIGURE_DEPENDS ${viewer_folder}/src/* ${viewer_folder}/*.html)
    add_custom_command(OUTPUT ${viewer_source}
      COMMAND ${GAUSSMAP_NODE} ${viewer_folder}/build.mjs ${PROJECT_BINARY_DIR}/viewer
      DEPENDS ${viewer_inputs} ${viewer_folder}/build.mjs ${viewer_folder}/package-lock.json
      COMMENT "Building the viewer" VERBATIM)
  endif()
else()
  message(STATUS "Built without the viewer: it needs node and npm")
endif()
target_sources(gaussmap PRIVATE ${viewer_source})
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${viewer_folder}/package-lock.json)
