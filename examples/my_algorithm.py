"""Four algorithms in Python, one for each stage.

    simbench run --python examples/my_algorithm.py --scenario 18cam_6host_45fps \\
        --pipelines yoon2021_both,yoon2021_both+mean_of_last+yoon2021,cristian+regression_30+in_order

    simbench run --python examples/my_algorithm.py --scenario 18cam_6host_30fps_without_trigger \\
        --pipelines phase_rate,two_way_hull+to_the_grid+two_way_poll_calibrated+yoon2021
"""

import collections

import simbench


@simbench.device_time("mean_of_last", window=30)
class MeanOfLast:
    """sensor stamp plus the mean of arrival less sensor stamp over the last frames"""

    def __init__(self, window):
        self.offsets = collections.deque(maxlen=window)

    def stamp(self, sample):
        self.offsets.append(sample.arrival_ns - sample.sensor_ns)
        return sample.sensor_ns + sum(self.offsets) / len(self.offsets)


@simbench.host_sync("cristian", questions=16)
async def cristian(host, settings):
    """sets the clock once, by the fastest answer"""
    master = host.channel(0)
    replies = [await master.exchange(timeout_ms=100) for _ in range(settings.questions)]
    answered = [reply for reply in replies if reply]
    if not answered:
        host.failed("no answer from the master; is it running?")
        return
    await host.clock.step(min(answered, key=lambda reply: reply.delay_ns).offset_ns)


@simbench.capture_alignment("to_the_grid", dead_band_us=100.0)
async def to_the_grid(host, camera, settings):
    """moves each camera to the grid of the common clock by the length of one frame"""
    period_ns = camera.frame_length_ns
    while True:
        exposure = await camera.next_frame()
        if not exposure.settled:
            continue
        late_ns = (exposure.exposed_ns + period_ns // 2) % period_ns - period_ns // 2
        camera.report(abs(late_ns) <= settings.dead_band_us * 1e3)
        if abs(late_ns) <= settings.dead_band_us * 1e3:
            continue
        by_ns = min(max(-late_ns, camera.shortest_ns - period_ns), camera.longest_ns - period_ns)
        if not await camera.adjust_frame(by_ns):
            return


@simbench.gathering("in_order")
class InOrder:
    """a set whenever the oldest frame of every camera lies within the interval"""

    def __init__(self, setup):
        self.interval_ns = setup.interval_ns
        self.waiting = [collections.deque(maxlen=setup.queue_limit) for _ in range(setup.sources)]

    def push(self, frame):
        self.waiting[frame.source].append(frame)
        sets = []
        while all(self.waiting):
            first = [queue[0] for queue in self.waiting]
            oldest = min(first, key=lambda waiting: waiting.stamp_ns)
            newest = max(first, key=lambda waiting: waiting.stamp_ns)
            if newest.stamp_ns - oldest.stamp_ns <= self.interval_ns:
                sets.append([queue.popleft() for queue in self.waiting])
            else:
                self.waiting[oldest.source].popleft()
        return sets
