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

# any_fits(OUT CASE PATTERNS): whether the beginning of Suite.Case matches one of them.
function(any_fits out case patterns)
  set(${out} FALSE PARENT_SCOPE)
  foreach(pattern IN LISTS patterns)
    if(case MATCHES "^${name}\\.(${pattern})")
      set(${out} TRUE PARENT_SCOPE)
    endif()
  endforeach()
endfunction()

# A pattern that fits no case was left behind when a test got another name.
foreach(pattern IN LISTS nightly_cases alone_cases)
  set(fitting ${cases})
  list(FILTER fitting INCLUDE REGEX "^${name}\\.(${pattern})")
  if(NOT fitting)
    message(SEND_ERROR "${name}: no case matches ${pattern}")
  endif()
endforeach()

foreach(case IN LISTS cases)
  any_fits(nightly "${case}" "${nightly_cases}")
  any_fits(alone "${case}" "${alone_cases}")
  set(labels "")
  set(limit_s ${day_limit_s})
  if(is_nightly OR nightly)
    list(APPEND labels nightly)
    set(limit_s ${night_limit_s})
  endif()
  if(lock)
    list(APPEND labels loopback)
  endif()
  set_tests_properties("${case}" PROPERTIES TIMEOUT ${limit_s} RUN_SERIAL ${alone}
    LABELS "${labels}" ENVIRONMENT "${environment}" RESOURCE_LOCK "${lock}")
endforeach()
