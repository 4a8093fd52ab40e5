"""What the runs amount to: means, intervals, times at equal error."""
import math

STUDENT = {2: 12.71, 3: 4.30, 4: 3.18, 5: 2.78, 6: 2.57, 7: 2.45, 8: 2.36, 9: 2.31, 10: 2.26}  # 97.5 % quantile, by number of values


def mean(values):
    values = list(values)
    return sum(values) / len(values)


def half_interval(values):
    """Half of the 95 % interval of the mean; None for one value."""
    values = list(values)
    if len(values) < 2:
        return None
    m = mean(values)
    return STUDENT.get(len(values), 2.1) * math.sqrt(sum((v - m)**2 for v in values) / (len(values) - 1) / len(values))


class Point:
    """The runs of one method with one setting on one scene. Errors in per cent. `reference`: the record of what they were compared with; its
    noise is taken out of the mean square error, which leaves a standard deviation of noise^2 sqrt(2 / organs): below twice that
    an error cannot be told from zero."""

    def __init__(self, records, reference):
        self.records, self.reference = records, reference
        r = records[0]
        self.method, self.setting = r['method'], r['setting']
        self.cpu, self.wall = mean(r['cpu_s'] for r in records), mean(r['wall_s'] for r in records)
        self.peak = max(r['peak_bytes'] for r in records)
        self.counts, self.iterations = r['counts'], r['iterations']
        self.noise = 'noise' in r
        self.certified = self.setting[-1] in '%+'  # not among those that times and errors are compared of

    def errors(self, what, band):
        """One for each run: rms error; of path tracing its noise."""
        return [100 * (r['noise'].get(what, {}).get(band, 0) if self.noise else r['error'][what][band]['rmse']) for r in self.records]

    def floor(self, what, band):
        noise = 0 if self.noise else 100 * self.reference['noise'].get(what, {}).get(band, 0)
        return noise * math.sqrt(2 * math.sqrt(2 / self.reference[what]))

    def seen(self, what, band):
        """Can the error be told from zero?"""
        return math.sqrt(mean(e * e for e in self.errors(what, band))) >= self.floor(what, band)

    def error(self, what, band):
        """Or what it is below."""
        return max(math.sqrt(mean(e * e for e in self.errors(what, band))), self.floor(what, band), 1e-6)

    def interval(self, what, band):
        half = half_interval(self.errors(what, band)) if self.seen(what, band) else None
        m = self.error(what, band)
        return (None, None) if half is None else (max(m - half, 0.02 * m), m + half)

    def bias(self, what, band):
        return None if self.noise else mean(100 * r['error'][what][band]['bias'] for r in self.records)


def curve(points, band, aim):
    """CPU seconds that a method's points need for an error in one band, by interpolation between settings in logarithms. Where even the
    cheapest is better, its time (an upper bound); None where the best is not good enough."""
    pairs = sorted((p.error('organs', band), p.cpu) for p in points)
    if not pairs or pairs[0][0] > aim:
        return None
    cheapest = min(t for _, t in pairs)
    if aim >= pairs[-1][0]:
        return pairs[-1][1] if pairs[-1][1] <= cheapest else cheapest
    for (e0, t0), (e1, t1) in zip(pairs, pairs[1:]):
        if e0 <= aim <= e1:
            share = (math.log(aim) - math.log(e0)) / (math.log(e1) - math.log(e0)) if e1 > e0 else 0
            return math.exp(math.log(t0) + share * (math.log(t1) - math.log(t0)))
    return None


def path_tracing(points, band, aim, like=()):
    """CPU seconds that path tracing needs for its noise to fall to `aim`: between two runs by interpolation in logarithms, outside as
    1 / aim^2 from the nearest. `like`: where the scene itself has but one run, how noise falls with the samples is taken from these."""
    pairs = sorted(((p.error('organs', band), p.cpu) for p in points), reverse=True)
    if not pairs:
        return None
    if len(pairs) == 1 and len(like) > 1:
        e0, t0 = pairs[0]
        own = path_tracing(like, band, e0)
        return t0 * path_tracing(like, band, aim) / own
    if aim >= pairs[0][0]:
        e, t = pairs[0]
        return t * (e / aim)**2
    if aim <= pairs[-1][0]:
        e, t = pairs[-1]
        return t * (e / aim)**2
    for (e0, t0), (e1, t1) in zip(pairs, pairs[1:]):
        if e1 <= aim <= e0:
            share = (math.log(aim) - math.log(e0)) / (math.log(e1) - math.log(e0))
            return math.exp(math.log(t0) + share * (math.log(t1) - math.log(t0)))
    return None


def for_both(time_of, aims):
    """The larger of the times for the bands' aims; None if one cannot be met."""
    times = [time_of(band, aim) for band, aim in aims.items()]
    return None if any(t is None for t in times) else max(times)
