# The cases that people run, held against their references by the program that people use, at a spacing that is
# affordable here. DUET_CASE(NAME CASE [--set ...]).
function(duet_case name case)
    add_test(NAME verification.case.${name}
        COMMAND duet verify ${PROJECT_SOURCE_DIR}/cases/${case} ${ARGN}
            --output ${PROJECT_BINARY_DIR}/cases/${name} --overwrite)
    set_tests_properties(verification.case.${name} PROPERTIES LABELS verification TIMEOUT 600 PROCESSORS 2)
endfunction()

if(TARGET duet AND TARGET duet-solid AND TARGET duet-fluid)
    duet_case(hot_plate hot_plate --set fluid.spacing=0.125 --set solid.body[0].element_size=0.0625)
    duet_case(heated_cavity heated_cavity/Ra1e5.toml)
    duet_case(channel channel)
    duet_case(eddies channel/eddies.toml)
    duet_case(flexible_beam flexible_beam --set fluid.spacing=0.15625 --set time.end=5.5)
    duet_case(conducting_body conducting_body --set fluid.spacing=0.3125 --set solid.body[0].element_size=0.15625)
    duet_case(two_layers two_layers)
    duet_case(two_layers_conductive two_layers/conductive.toml)
    duet_case(two_layers_equal two_layers/equal.toml)
    duet_case(released_cylinder released_cylinder)
    duet_case(released_rigid_cylinder released_cylinder --set "solid.body[0].motion=\"rigid\"")
    # A disc as light as the fluid, soft, both sides at once: the exchange feeds its vibrations to 4e-4 J/m if it is let.
    # (7.8, 7.8 and 7.9e-9 J/m at spacings of 0.0125, 0.01 and 0.0067 m.)
    duet_case(light_cylinder released_cylinder --set fluid.spacing=0.02 --set solid.body[0].element_size=0.02
        --set time.end=0.2 --set time.window=0 --set solid.body[0].density=1 --set solid.body[0].youngs_modulus=1e3
        --set coupling.schedule=parallel
        --set "check=[{ quantity = 'solid.kinetic_energy', value = 7.85e-9, norm = 'relative', tolerance = 0.05 }]")
    duet_case(ring_torque ring_torque)
    duet_case(torsional_ring torsional_ring)
    duet_case(insulated_beam flexible_beam/adiabatic.toml --set fluid.spacing=0.2 --set time.end=3)
    duet_case(stratified_fin stratified_fin --set fluid.spacing=0.2 --set time.end=1)
endif()
