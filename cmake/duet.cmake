# The few build rules that every room shares.

add_library(duet_options INTERFACE)
target_compile_options(duet_options INTERFACE -Wall -Wextra -Wconversion -Wshadow)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
    # GCC 12 warns of overlap in "literal" + std::string (its bug 105651).
    target_compile_options(duet_options INTERFACE -Wno-restrict)
endif()
target_include_directories(duet_options INTERFACE ${PROJECT_SOURCE_DIR})
target_compile_definitions(duet_options INTERFACE DUET_VERSION="${PROJECT_VERSION}")
if(DUET_NATIVE)
    target_compile_options(duet_options INTERFACE -march=native)
endif()

# duet_library(NAME SOURCES... ): a static library with the project's warnings and include root.
function(duet_library name)
    add_library(${name} STATIC ${ARGN})
    target_link_libraries(${name} PUBLIC duet_options)
    set_target_properties(${name} PROPERTIES POSITION_INDEPENDENT_CODE ON)
endfunction()

# duet_test(NAME LABEL LABEL SOURCES ... LIBRARIES ...): one GoogleTest program; each TEST is a ctest.
# Tests of real processes measure how soon a failure is seen, so they run alone. Threads sleep where they wait for each
# other, as in a run: with more tests than cores those that spin take the time of the others.
function(duet_test name)
    cmake_parse_arguments(arg "" "LABEL;TIMEOUT" "SOURCES;LIBRARIES" ${ARGN})
    if(NOT arg_TIMEOUT)
        set(arg_TIMEOUT 120)
    endif()
    set(alone FALSE)
    if(arg_LABEL STREQUAL "process")
        set(alone TRUE)
    endif()
    add_executable(${name} ${arg_SOURCES})
    target_link_libraries(${name} PRIVATE duet_options ${arg_LIBRARIES} GTest::gtest_main)
    target_compile_definitions(${name} PRIVATE DUET_SOURCE_DIR="${PROJECT_SOURCE_DIR}" DUET_BINARY_DIR="${PROJECT_BINARY_DIR}")
    gtest_discover_tests(${name} DISCOVERY_TIMEOUT 30 TEST_PREFIX "${arg_LABEL}." PROPERTIES ENVIRONMENT "OMP_WAIT_POLICY=passive" LABELS ${arg_LABEL} TIMEOUT ${arg_TIMEOUT} RUN_SERIAL ${alone})
endfunction()
