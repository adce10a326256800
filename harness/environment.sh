# Environment of the programs; to be sourced.

# Mesa would ask a display which GPU to prefer, and complain where there is none.
export NODEVICE_SELECT=1

# Mesa's CPU drivers cut a dispatch into one part for each of their threads. On few cores the system often queues two
# threads on one core; with two threads a core, an idle core finds another to run.
cores=$(getconf _NPROCESSORS_ONLN 2>/dev/null || echo 8)
if [ "$cores" -lt 8 ]; then export LP_NUM_THREADS="${LP_NUM_THREADS:-$((2 * cores))}"; fi
unset cores
