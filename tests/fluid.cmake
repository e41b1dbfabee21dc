duet_test(fluid_unit LABEL unit
    SOURCES unit/fluid_kernel.cpp unit/fluid_neighbours.cpp unit/fluid_boundary.cpp unit/fluid_ghosts.cpp
        unit/fluid_operators.cpp unit/fluid_budget.cpp unit/fluid_pressure.cpp unit/fluid_state.cpp
    LIBRARIES duet_fluid_core)

duet_test(fluid_verification LABEL verification
    SOURCES verification/fluid_slab.cpp verification/fluid_two_layers.cpp verification/fluid_cavity.cpp
        verification/fluid_hot_plate.cpp verification/fluid_stokes_mode.cpp
    LIBRARIES duet_fluid_core)
