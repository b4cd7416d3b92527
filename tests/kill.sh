#!/usr/bin/env bash
# Kills the window in the middle of edits and looks at what stays: `tests/kill.sh BURNISH [TRIES]`.
#
# Needs Xvfb and xdotool. Each try opens a document in a real window, adds materials by Ctrl+N every one or two seconds and saves
# now and then; at a random moment it is killed. Then the document must be whole, the recovery file must be whole, and
# every edit that is older than ten seconds must be in one of them. The next start takes it up.
set -eu

program=$(realpath "$1")
tries=${2:-20}
grace_secs=10
folder=$(mktemp -d)
export XDG_DATA_HOME="$folder/data" XDG_CONFIG_HOME="$folder/config" XDG_RUNTIME_DIR="$folder" DISPLAY=":$((100 + $$ % 400))"
unset WAYLAND_DISPLAY WAYLAND_SOCKET
Xvfb "$DISPLAY" -screen 0 1280x800x24 -nolisten tcp >/dev/null 2>&1 &
server=$!
window=''
finish() {
    [ -z "$window" ] || kill -9 "$window" 2>/dev/null || true
    kill "$server" 2>/dev/null || true
    rm -rf "$folder"
}
trap finish EXIT
sleep 1

stop() {
    printf 'kill.sh: try %s: %s\n' "$try" "$*" >&2
    exit 1
}

document="$folder/bench.burnish"
# Materials that Ctrl+N added are the edits that are counted.
edits_in() { grep -c '"name": "Material' "$1" || true; }
now() { date +%s; }

open() { # ARGS: opens the window and waits for it
    "$program" "$@" >"$folder/log" 2>&1 &
    window=$!
    local start id=''
    start=$(now)
    while [ -z "$id" ]; do
        [ $(($(now) - start)) -lt 90 ] || stop "no window: $(cat "$folder/log")"
        kill -0 "$window" 2>/dev/null || stop "it ended: $(cat "$folder/log")"
        sleep 0.2
        id=$(xdotool search --name 'bench.* - Burnish$' 2>/dev/null | head -1) || true
    done
    xdotool windowfocus "$id"
}

for try in $(seq "$tries"); do
    rm -rf "$folder/data"
    cat >"$document" <<'JSON'
{"format": "burnish-document", "version": 1, "scene": "gallery:workbench"}
JSON
    open "$document"
    start=$(now)
    length=$((grace_secs + 2 + RANDOM % 12))
    # What must not be lost: the edits of ten seconds before the end.
    times='' presses=0
    while [ $(($(now) - start)) -lt "$length" ]; do
        xdotool key ctrl+n
        presses=$((presses + 1))
        times="$times $(now)"
        [ $((RANDOM % 9)) != 0 ] || xdotool key ctrl+s
        sleep "1.$((RANDOM % 9))" # slower than frames on a busy machine: two presses in one frame are one
    done
    kill -9 "$window"
    wait "$window" 2>/dev/null || true
    end=$(now)
    window=''
    due=0
    for time in $times; do [ $((end - time)) -le "$grace_secs" ] || due=$((due + 1)); done

    "$program" info "$document" >/dev/null 2>"$folder/log" || stop "the document is damaged: $(cat "$folder/log")"
    kept=$(edits_in "$document")
    for file in "$folder"/data/burnish/recovery/*.json; do
        [ -e "$file" ] || continue
        # A whole file ends in the brace that closes it.
        [ "$(tail -c 2 "$file")" = '}' ] || stop "$file is cut off"
        found=$(edits_in "$file")
        [ "$found" -le "$kept" ] || kept=$found
    done
    [ "$kept" -ge "$due" ] || stop "$kept edits stayed of $due that were $grace_secs s old ($presses in all)"
    printf 'try %s: killed after %s s, %s keys pressed, %s edits kept\n' "$try" "$length" "$presses" "$kept"

    if ls "$folder"/data/burnish/recovery/*.json >/dev/null 2>&1; then
        open --recover
        kill -9 "$window"
        wait "$window" 2>/dev/null || true
        window=''
    fi
done
printf '%s tries: files whole, every edit older than %s s kept\n' "$tries" "$grace_secs"
