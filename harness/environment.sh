# Environment of the programs; source this file.

# Otherwise Mesa queries a display for the preferred GPU, and prints an error if there is no display.
export NODEVICE_SELECT=1

# Mesa's CPU drivers split a dispatch into one part per driver thread. With few cores the system often queues two
# threads on one core; with two threads per core, an idle core can take over another one.
cores=$(getconf _NPROCESSORS_ONLN 2>/dev/null || echo 8)
if [ "$cores" -lt 8 ]; then export LP_NUM_THREADS="${LP_NUM_THREADS:-$((2 * cores))}"; fi
unset cores
