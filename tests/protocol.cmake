# Tests of the protocol room.
duet_test(test_protocol_schedule LABEL unit
    SOURCES unit/protocol_schedule.cpp
    LIBRARIES duet_protocol)
duet_test(test_protocol_function LABEL unit
    SOURCES unit/protocol_function.cpp
    LIBRARIES duet_protocol)
duet_test(test_protocol_codec LABEL unit
    SOURCES unit/protocol_codec.cpp
    LIBRARIES duet_protocol)
add_executable(test_slow_solid process/protocol_slow_solid.cpp)
target_link_libraries(test_slow_solid PRIVATE duet_protocol)
duet_test(test_protocol_run LABEL process
    SOURCES process/protocol_run.cpp process/protocol_session.cpp process/protocol_trouble.cpp process/protocol_stage.cpp
    LIBRARIES duet_protocol)
add_dependencies(test_protocol_run duet-minimal-solid duet-minimal-fluid test_slow_solid)
add_test(NAME protocol.python_function COMMAND /usr/bin/python3 ${CMAKE_CURRENT_LIST_DIR}/tools/test_function.py)
set_tests_properties(protocol.python_function PROPERTIES LABELS unit TIMEOUT 60)
