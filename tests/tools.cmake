# The plots of tools/, drawn from a small run's folder.
add_executable(make_run tools/make_run.cpp)
target_link_libraries(make_run PRIVATE duet_snapshot)
add_test(NAME tools.plots
    COMMAND /usr/bin/python3 ${CMAKE_CURRENT_LIST_DIR}/tools/test_plots.py $<TARGET_FILE:make_run>)
set_tests_properties(tools.plots PROPERTIES LABELS unit TIMEOUT 300)
