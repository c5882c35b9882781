# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
# Read by ctest, once for each test program, after it has found the program's cases. The variables
# are set by the script that PalpateTests.cmake writes.

# A time limit ends what hangs; it is no requirement on speed. Tests of the day take at most 10 s
# on a machine without other work, those of the night at most 5 minutes.
set(day_limit_s 300)
set(night_limit_s 3600)

if(NOT EXISTS ${program})
  if(is_nightly)
    set_tests_properties(${name}_test_NOT_BUILT PROPERTIES LABELS nightly)
  endif()
  return()
endif()

foreach(case IN LISTS cases)
  string(REPLACE "${name}." "" short "${case}")
  set(labels "")
  set(limit_s ${day_limit_s})
  set(nightly ${is_nightly})
  foreach(pattern IN LISTS nightly_cases)
    if(short MATCHES "${pattern}")
      set(nightly TRUE)
    endif()
  endforeach()
  if(nightly)
    list(APPEND labels nightly)
    set(limit_s ${night_limit_s})
  endif()
  if(lock)
    list(APPEND labels loopback)
  endif()
  set(alone FALSE)
  foreach(pattern IN LISTS alone_cases)
    if(short MATCHES "${pattern}")
      set(alone TRUE)
    endif()
  endforeach()
  set_tests_properties("${case}" PROPERTIES TIMEOUT ${limit_s} RUN_SERIAL ${alone}
    LABELS "${labels}" ENVIRONMENT "${environment}" RESOURCE_LOCK "${lock}")
endforeach()
