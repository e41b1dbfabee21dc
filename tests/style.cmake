# Skipped where clang-format 14 is not installed: other versions format otherwise.
find_program(CLANG_FORMAT clang-format-14)
add_test(NAME style.clang_format
    COMMAND ${CMAKE_COMMAND} -DCLANG_FORMAT=${CLANG_FORMAT} -P ${CMAKE_CURRENT_LIST_DIR}/style/clang_format.cmake
    WORKING_DIRECTORY ${PROJECT_SOURCE_DIR})
set_tests_properties(style.clang_format PROPERTIES LABELS style TIMEOUT 120 SKIP_REGULAR_EXPRESSION "clang-format-14 is not installed")
