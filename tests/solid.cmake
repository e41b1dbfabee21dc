duet_test(solid_unit LABEL unit
    SOURCES unit/solid_mesh.cpp unit/solid_smoothing.cpp unit/solid_heat.cpp unit/solid_equilibrium.cpp unit/solid_loads.cpp unit/solid_implicit.cpp unit/solid_plane.cpp unit/solid_updated.cpp unit/solid_mechanics.cpp
        unit/solid_interface.cpp unit/solid_energy.cpp unit/solid_rigid.cpp unit/solid_state.cpp
    LIBRARIES duet_solid_core)

duet_test(solid_verification LABEL verification
    SOURCES verification/solid_conduction.cpp verification/solid_wave.cpp verification/solid_cantilever.cpp verification/solid_dispersion.cpp
        verification/solid_statics.cpp
    LIBRARIES duet_solid_core)

duet_test(solid_participant_unit LABEL unit
    SOURCES unit/solid_participant.cpp unit/solid_msh.cpp
    LIBRARIES duet_solid_participant)

duet_test(solid_allocation LABEL unit
    SOURCES unit/solid_allocation.cpp
    LIBRARIES duet_solid_core)
