duet_test(orchestrator_unit LABEL unit
    SOURCES unit/orchestrator_case_file.cpp unit/orchestrator_scene_check.cpp unit/orchestrator_calendar.cpp
            unit/orchestrator_audit.cpp unit/orchestrator_verify.cpp unit/orchestrator_sweep.cpp
            unit/orchestrator_check_report.cpp unit/orchestrator_scene_bodies.cpp
    LIBRARIES duet_run)
