"""How often Holm's correction lets a family of ratios at their margins have a wrong outcome if groups share variance.

Prints, for each share of the variance that the ratios of a group have in common, the percentage of simulated families
in which at least one interval excludes its margin. That is the first step of Holm's procedure: the least p-value is at
most 5 % over the number of ratios.
"""

import math
import random
import statistics

FAMILIES, RATIOS, GROUP = 20_000, 88, 4
LEVEL = 0.05

random.seed(1)
critical = statistics.NormalDist().inv_cdf(1 - LEVEL / RATIOS / 2)
for share in (0, 0.5, 0.9):
    own, common = math.sqrt(1 - share), math.sqrt(share)
    wrong = 0
    for _ in range(FAMILIES):
        for _ in range(RATIOS // GROUP):
            group = common * random.gauss(0, 1)
            if any(abs(group + own * random.gauss(0, 1)) > critical for _ in range(GROUP)):
                wrong += 1
                break
    print(f"{share:.0%} of the variance in common: {100 * wrong / FAMILIES:.1f} % of families have a wrong outcome")
