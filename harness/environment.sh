# Environment of the programs; to be sourced.

# Mesa would ask a display which GPU to prefer, and complain where there is none.
export NODEVICE_SELECT=1

# Mesa's CPU drivers cut a dispatch into as many pieces as they have threads. With one a core, systems with few cores
# often let two pieces wait for the same core; with two a core, an idle one finds more to take. 16 is their most.
cores=$(getconf _NPROCESSORS_ONLN 2>/dev/null || echo 1)
export LP_NUM_THREADS="${LP_NUM_THREADS:-$((cores < 8 ? 2 * cores : 16))}"
unset cores
