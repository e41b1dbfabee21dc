duet_test(solid_unit LABEL unit
    SOURCES unit/solid_mesh.cpp unit/solid_smoothing.cpp unit/solid_heat.cpp unit/solid_mechanics.cpp
        unit/solid_interface.cpp unit/solid_state.cpp
    LIBRARIES duet_solid_core)
