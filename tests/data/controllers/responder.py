"""A controller that steers straight on, and in period 2 does what options.mode says."""

import json
import os
import signal
import subprocess
import sys
import time

FAILS_IN = 2


def say(answer):
    print(answer if isinstance(answer, str) else json.dumps(answer), flush=True)


def misbehave(mode, good):
    if mode == "crash":
        os.kill(os.getpid(), signal.SIGSEGV)
    elif mode == "exit":
        print("Traceback\nZeroDivisionError: division by zero", file=sys.stderr, flush=True)
        sys.exit(7)
    elif mode == "hang":
        time.sleep(1000)
    elif mode == "stubborn":
        signal.signal(signal.SIGTERM, signal.SIG_IGN)
        time.sleep(1000)
    elif mode == "twice":
        say(json.dumps(good) + "\n" + json.dumps(good))
    elif mode == "half":
        print('{"input": [0', end="", flush=True)
        os._exit(0)
    elif mode == "long":
        say("[" + "0," * (9 << 20) + "0]")
    elif mode == "deaf":
        os.close(0)
        say(good)
        time.sleep(1000)
    else:
        say({"nan": '{"input": [NaN]}', "inf": '{"input": [1e999]}', "size": {"input": [0.0, 0.0]},
             "bounds": {"input": [99.0]}, "text": "steer straight on", "list": "[0.0]",
             "other": {"output": [0.0]}, "word": {"input": ["0"]}, "error": {"error": "no way out"},
             "period": {"input": [0.0], "period": 1}, "silence": ""}[mode])


def main():
    scenario = json.loads(sys.stdin.readline())
    options = scenario["options"]
    mode = options.get("mode", "good")
    if "pids" in options:
        # A child in its own session, which only a kill ends.
        child = subprocess.Popen(
            [sys.executable, "-c",
             "import os, signal, time; os.setsid(); signal.signal(signal.SIGTERM, signal.SIG_IGN)\n"
             "print('ready', flush=True)\ntime.sleep(1000)"], stdout=subprocess.PIPE)
        child.stdout.readline()
        with open(options["pids"], "a", encoding="utf-8") as file:
            print(os.getpid(), child.pid, file=file)
    if "descriptors" in options:
        numbers = os.listdir("/proc/self/fd")
        still_open = [number for number in numbers if os.path.exists("/proc/self/fd/" + number)]
        with open(options["descriptors"], "w", encoding="utf-8") as file:
            print(*sorted(still_open), file=file)
    if mode == "no_greeting":
        time.sleep(1000)
    print("controller of", scenario["name"], file=sys.stderr, flush=True)
    say({"protocol": 7 if mode == "old" else 1})
    if mode == "early":
        say({"input": [0.0]})
    seed = None
    for line in sys.stdin:
        message = json.loads(line)
        if message["type"] == "end":
            break
        if message["type"] == "reset":
            seed = message["seed"]
            print("drive", seed, file=sys.stderr, flush=True)
            continue
        inputs = len(scenario["system"]["inputs"])
        answer = {"input": [0.01 * (seed % 10)] * inputs, "period": message["period"]}
        if scenario["plans"]:
            stages = scenario["horizon"]
            answer = {"plan": {"inputs": [[0.1]] * stages, "gains": [[[0.0, -0.5, -1.0]]] * stages,
                               "status": "stalled", "evaluations": 3}}
        if mode == "leaves":
            say(answer)
            if message["period"] == scenario["step_limit"] - 1:
                os._exit(0)
        elif message["period"] == FAILS_IN and mode not in ("good", "early"):
            misbehave(mode, answer)
        else:
            say(answer)


main()
