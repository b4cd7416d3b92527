#!/usr/bin/env bash
# Kills the window in the middle of edits and looks at what stays: `tests/kill.sh BURNISH [TRIES]`.
#
# Needs Xvfb, xdotool and python3. Each try opens a document in a real window, adds materials by Ctrl+N every one or two seconds and saves
# now and then; at a random moment it is killed. Then the document must be whole, the recovery file must be whole, and
# every edit that is older than ten seconds must be in one of them. The next start takes the recovery file up: its window
# shows the document as unsaved, and saving it brings all those edits into the document.
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

# No other window of the program has it in its title: that of the default scene ends in `bench`.
name=kill-trial
document="$folder/$name.burnish"
# Materials that Ctrl+N added are the edits that are counted, in a document or a recovery file. Fails unless it is whole.
edits_in() {
    python3 - "$1" <<'PYTHON'
import json, sys
with open(sys.argv[1], encoding="utf-8") as file:
    content = json.load(file)
materials = content.get("document", content).get("materials", [])
print(sum(material["name"].startswith("Material") for material in materials))
PYTHON
}
now() { date +%s; }

id=''
await() { # TITLE: waits for the window with this title, a regular expression
    local start
    start=$(now)
    id=''
    while [ -z "$id" ]; do
        [ $(($(now) - start)) -lt 90 ] || stop "no window is called $1: $(cat "$folder/log")"
        kill -0 "$window" 2>/dev/null || stop "it ended: $(cat "$folder/log")"
        sleep 0.2
        id=$(xdotool search --name "$1" 2>/dev/null | head -1) || true
    done
}

open() { # TITLE ARGS: opens the window and waits for it
    local title=$1
    shift
    "$program" "$@" >"$folder/log" 2>&1 &
    window=$!
    await "$title"
    xdotool windowfocus "$id"
}

end() {
    kill -9 "$window"
    wait "$window" 2>/dev/null || true
    window=''
}

for try in $(seq "$tries"); do
    rm -rf "$folder/data"
    cat >"$document" <<'JSON'
{"format": "burnish-document", "version": 1, "scene": "gallery:workbench"}
JSON
    open "^$name\\*? - Burnish\$" "$document"
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
    end
    ended=$(now)
    due=0
    for time in $times; do [ $((ended - time)) -le "$grace_secs" ] || due=$((due + 1)); done

    "$program" info "$document" >/dev/null 2>"$folder/log" || stop "the document is damaged: $(cat "$folder/log")"
    kept=$(edits_in "$document") || stop "the document is damaged"
    recoverable=''
    for file in "$folder"/data/burnish/recovery/*.json; do
        [ -e "$file" ] || continue
        found=$(edits_in "$file") || stop "$file is damaged"
        recoverable=$found
        [ "$found" -le "$kept" ] || kept=$found
    done
    [ "$kept" -ge "$due" ] || stop "$kept edits stayed of $due that were $grace_secs s old ($presses in all)"
    printf 'try %s: killed after %s s, %s keys pressed, %s edits kept\n' "$try" "$length" "$presses" "$kept"

    if [ -n "$recoverable" ]; then
        open "^$name\\* - Burnish\$" --recover
        xdotool key ctrl+s
        await "^$name - Burnish\$"
        end
        recovered=$(edits_in "$document") || stop "the recovered document is damaged"
        [ "$recovered" = "$recoverable" ] || stop "$recovered edits were recovered of $recoverable in the recovery file"
        [ "$recovered" -ge "$due" ] || stop "$recovered edits were recovered of $due that were $grace_secs s old"
    fi
done
printf '%s tries: files whole, every edit older than %s s kept\n' "$tries" "$grace_secs"
