duet_test(snapshot_unit LABEL unit
    SOURCES unit/snapshot_series.cpp unit/snapshot_hdf5.cpp
    LIBRARIES duet_snapshot)
