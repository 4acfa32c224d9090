# Accuracy against peers (accuracy.py): shapes with exact density and, where they are installed, the peers in C++. Built by
# the target bench_accuracy alone.
add_custom_target(bench_accuracy DEPENDS gaussmap_cli)

function(accuracy_program name)
  add_executable(bench_${name} EXCLUDE_FROM_ALL ${ARGN})
  set_target_properties(bench_${name} PROPERTIES OUTPUT_NAME ${name})
  target_link_libraries(bench_${name} PRIVATE gaussmap::gaussmap)
  target_include_directories(bench_${name} PRIVATE ${CMAKE_CURRENT_SOURCE_DIR})
  add_dependencies(bench_accuracy bench_${name})
endfunction()

accuracy_program(surfaces surfaces/main.cpp surfaces/more_surfaces.cpp surfaces/sampling.cpp)
target_link_libraries(bench_surfaces PRIVATE gaussmap_flags)

# Each peer is compiled with its own library's options alone.
find_package(Eigen3 QUIET NO_MODULE)
find_package(CGAL QUIET)
if(CGAL_FOUND AND Eigen3_FOUND)
  accuracy_program(cgal_jets cloud_curvature/cgal_jets.cpp judge.cpp)
  target_link_libraries(bench_cgal_jets PRIVATE CGAL::CGAL Eigen3::Eigen)
  target_compile_definitions(bench_cgal_jets PRIVATE CGAL_EIGEN3_ENABLED)
  accuracy_program(cgal_vcm cloud_curvature/cgal_vcm.cpp judge.cpp)
  target_link_libraries(bench_cgal_vcm PRIVATE CGAL::CGAL Eigen3::Eigen)
  target_compile_definitions(bench_cgal_vcm PRIVATE CGAL_EIGEN3_ENABLED)
else()
  message(STATUS "bench: no CGAL, no rows of its jets and Voronoi covariances")
endif()
# Not by PCL's own configuration, which asks for VTK and MPI.
find_path(PCL_INCLUDE_DIR pcl/features/principal_curvatures.h PATH_SUFFIXES pcl-1.15 pcl-1.14 pcl-1.13 pcl-1.12)
find_library(PCL_FEATURES_LIBRARY pcl_features)
if(PCL_INCLUDE_DIR AND PCL_FEATURES_LIBRARY AND Eigen3_FOUND)
  accuracy_program(pcl_curvatures cloud_curvature/pcl_curvatures.cpp judge.cpp)
  target_include_directories(bench_pcl_curvatures SYSTEM PRIVATE ${PCL_INCLUDE_DIR})
  target_link_libraries(bench_pcl_curvatures PRIVATE ${PCL_FEATURES_LIBRARY} pcl_search pcl_kdtree pcl_common lz4 Eigen3::Eigen)
else()
  message(STATUS "bench: no PCL, no rows of it")
endif()
