# Tests of the protocol room.
duet_test(test_protocol_schedule LABEL unit
    SOURCES unit/protocol_schedule.cpp
    LIBRARIES duet_protocol)
duet_test(test_protocol_codec LABEL unit
    SOURCES unit/protocol_codec.cpp
    LIBRARIES duet_protocol)
duet_test(test_protocol_run LABEL process
    SOURCES process/protocol_run.cpp process/protocol_stage.cpp
    LIBRARIES duet_protocol)
add_dependencies(test_protocol_run duet-minimal-solid duet-minimal-fluid)
