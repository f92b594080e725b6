"""What the rows of tools/gpu_check stand beside: the bars of the project and figures of other programs."""

FEW, MILLION, EIGHT_MILLION, MOST = 1 << 16, 1 << 20, 1 << 23, 64_000_000

# G/s on these cards [particles: rate]: goals of the project, 7 and 6 at eight million with what a step has to do beside the
# prototype's. A dragon in seconds.
CARDS = ("H100", "H200")
BARS = {("newtonian", FEW): 1, ("newtonian", MILLION): 6, ("newtonian", EIGHT_MILLION): 7,
        ("snow", MILLION): 5, ("snow", EIGHT_MILLION): 6}
DRAGON_BAR = 30

# G/s of other programs, with all parts of their step, 8 particles a cell. Measured for this project on 26 November 2026 on an
# H100 (80 GB, HBM3); Warp 1.3.3 and Taichi 1.7.4 as plain MLS-MPM, particles in order.
PEERS_CARD = "H100 80GB HBM3, 26 November 2026"
PEERS = {
    ("newtonian", MILLION): {"claymore, J fluid": 1.56, "claymore, its g2p2g alone": 2.49, "Warp": 1.32, "Taichi": 1.17,
                             "Warp, shuffled": 0.67, "Taichi, shuffled": 0.52},
    ("newtonian", EIGHT_MILLION): {"claymore, J fluid": 4.49, "claymore, its g2p2g alone": 5.69, "Warp": 1.42, "Taichi": 1.27},
    ("snow", MILLION): {"claymore, fixed corotated": 1.50, "claymore, its g2p2g alone": 2.35},
    ("snow", EIGHT_MILLION): {"claymore, fixed corotated": 3.33, "claymore, its g2p2g alone": 3.94},
}


def judge(rate_of, device, dragon):
    """The bars, and whether each holds. rate_of(material, particles): G/s, or None where it was not measured. `device`: its
    name. `dragon`: seconds, or None."""
    counts = any(card in device for card in CARDS)
    found = [{"what": f"{m}, {n:,} particles", "unit": "G/s", "at_least": bar, "found": rate_of(m, n)}
             for (m, n), bar in BARS.items()]
    found.append({"what": "the dragon, 120 frames", "unit": "s", "at_most": DRAGON_BAR, "found": dragon})
    for bar in found:
        rate = bar["found"]
        bar["holds"] = None if rate is None else rate >= bar["at_least"] if "at_least" in bar else rate <= bar["at_most"]
        bar["counts"] = counts
    return found
