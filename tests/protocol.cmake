# Tests of the protocol room.
duet_test(test_protocol_run LABEL process
    SOURCES process/protocol_run.cpp process/protocol_stage.cpp
    LIBRARIES duet_protocol)
add_dependencies(test_protocol_run duet-minimal-solid duet-minimal-fluid)
