duet_test(fluid_unit LABEL unit
    SOURCES unit/fluid_kernel.cpp unit/fluid_neighbours.cpp unit/fluid_boundary.cpp unit/fluid_ghosts.cpp
        unit/fluid_operators.cpp unit/fluid_walls.cpp unit/fluid_crossing.cpp unit/fluid_contact.cpp unit/fluid_budget.cpp unit/fluid_pressure.cpp unit/fluid_paper.cpp
        unit/fluid_state.cpp unit/fluid_twins.cpp unit/fluid_periodic.cpp
    LIBRARIES duet_fluid_core)

duet_test(fluid_scattered_unit LABEL unit
    SOURCES unit/fluid_scattered_state.cpp
    LIBRARIES duet_scattered)

duet_test(fluid_verification LABEL verification
    SOURCES verification/fluid_slab.cpp verification/fluid_two_layers.cpp verification/fluid_cavity.cpp
        verification/fluid_hot_plate.cpp verification/fluid_stokes_mode.cpp verification/fluid_round.cpp
        verification/fluid_lid.cpp verification/fluid_channel.cpp verification/fluid_periodic.cpp
    LIBRARIES duet_fluid_core)

# Instructions of one particle over one outer step with its inner steps, walls included (28 % of these
# particles have one in reach, a few two). Measured 3450; the ceiling leaves little for another compiler or processor.
# Only optimised code is worth counting.
if(CMAKE_BUILD_TYPE STREQUAL "Release" AND DUET_NATIVE)
    add_executable(fluid_steps performance/fluid_steps.cpp)
    target_link_libraries(fluid_steps PRIVATE duet_fluid_core)
    add_test(NAME performance.fluid_instructions
        COMMAND /usr/bin/python3 ${CMAKE_CURRENT_SOURCE_DIR}/performance/instructions.py $<TARGET_FILE:fluid_steps> 3510)
    set_tests_properties(performance.fluid_instructions PROPERTIES LABELS performance TIMEOUT 120 SKIP_RETURN_CODE 77)
endif()
