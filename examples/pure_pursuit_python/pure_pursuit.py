"""Pure pursuit (Coulter 1992) of a path, as an external controller of qsmpc.

Options: path, a list of points [x, y] in m; lookahead, m.
"""

import json
import math
import sys


def answer(message):
    # flush: qsmpc waits for the line, so it must not stay in a buffer.
    print(json.dumps(message), flush=True)


def point_ahead(path, position, lookahead):
    """The last point of the path within the distance `lookahead`, or else its nearest."""
    samples = [
        (start[0] + (end[0] - start[0]) * s / 50, start[1] + (end[1] - start[1]) * s / 50)
        for start, end in zip(path, path[1:])
        for s in range(51)
    ]
    distances = [math.dist(point, position) for point in samples]
    nearest = distances.index(min(distances))
    ahead = nearest
    for index in range(nearest, len(samples)):
        if distances[index] > lookahead:
            break
        ahead = index
    return samples[ahead]


def main():
    scenario = json.loads(sys.stdin.readline())
    system = scenario["system"]
    speed = system["parameters"]["speed"]
    lower, upper = system["inputs"][0]["lower"], system["inputs"][0]["upper"]
    path = scenario["options"]["path"]
    lookahead = scenario["options"]["lookahead"]
    answer({"protocol": 1})
    for line in sys.stdin:
        message = json.loads(line)
        if message["type"] == "end":
            break
        if message["type"] != "situation":
            continue  # a new drive: there is no state to carry over
        x, y, heading = message["observation"]
        goal = point_ahead(path, (x, y), lookahead)
        distance = max(math.dist(goal, (x, y)), 0.1)
        angle = math.atan2(goal[1] - y, goal[0] - x) - heading
        turn_rate = 2.0 * speed * math.sin(angle) / distance
        answer({"input": [min(max(turn_rate, lower), upper)]})


main()
