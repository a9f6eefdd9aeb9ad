# How ctest schedules the tests, read by ctest itself after the lists of tests that the programs gave it.
# By the clock: a host that sends in real time, a frame that is timed. They run alone, since what runs beside them takes
# their time; all others run two at a time, those that draw too.
set(by_the_clock "^(bench: ?(Suite (flight|host|globe)|A flood|A host gone wild|The speed)|system: ?(CIGI|channels: three live|protocols|replay|moving eye))")
# Long ones first, so that none is left over at the end.
set(long "^(bench: ?Suite|culling:|system: ?(bad input: 200|cracks: none|truth: eight|shards|panorama: the skyline))")
foreach(test IN LISTS test_bench_TESTS test_culling_TESTS test_system_TESTS)
  if(test MATCHES "${by_the_clock}")
    set_tests_properties("${test}" PROPERTIES RUN_SERIAL TRUE)
  elseif(test MATCHES "^system: ?(bad input|channels|cracks|horizon|panorama|truth)")
    # Tests of one kind write files of the same names.
    string(REPLACE "horizon" "channels" kind "${CMAKE_MATCH_1}")
    set_tests_properties("${test}" PROPERTIES RESOURCE_LOCK "files: ${kind}")
  endif()
  if(test MATCHES "${long}")
    set_tests_properties("${test}" PROPERTIES COST 100)
  endif()
endforeach()
