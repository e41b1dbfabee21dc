# Real processes, watched from outside. Timing is part of what they promise, so they run alone.
duet_test(process_run LABEL process TIMEOUT 180
    SOURCES process/run.cpp process/trouble.cpp process/duet_run.cpp
    LIBRARIES duet_run)
target_include_directories(process_run PRIVATE ${CMAKE_CURRENT_SOURCE_DIR})
add_dependencies(process_run duet duet-solid duet-fluid)
