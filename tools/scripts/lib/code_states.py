"""The gain of code errors as states over inflated variances, for a coordinate that moves as a random walk."""
import numpy as np

TIMES_S = (4.0, 8.0, 30.0)  # correlation times of the lasting error
WALKS = (0.003, 0.01, 0.03, 0.1, 0.3, 1.0)  # of the coordinate, sigmas of the code per root second
SHARE = 0.9  # of the code's variance that lasts


def with_state(walk, decay, share):
    """Variance of the coordinate, steady, by the filter of coordinate and error."""
    F, Q = np.diag([1.0, decay]), np.diag([walk**2, share * (1 - decay**2)])
    H, P = np.ones((1, 2)), np.diag([100.0, share])
    for _ in range(100_000):
        predicted = F @ P @ F.T + Q
        spread = predicted @ H.T
        updated = predicted - spread @ spread.T / ((H @ spread).item() + 1 - share)
        if np.abs(updated - P).max() < 1e-14:
            break
        P = updated
    return P[0, 0]


def inflated(walk, decay, share):
    """(true variance, stated variance) of the coordinate, steady, by the filter that takes the code as white."""
    noise = (1 + (2 * share - 1) * decay) / (1 - decay)
    stated = 100.0
    for _ in range(100_000):
        predicted = stated + walk**2
        gain = predicted / (predicted + noise)
        stated = (1 - gain) * predicted
    # Of (estimate's error, lasting error): e' = (1 - K) (e + w) - K (b' + n), b' = decay b + v.
    A = np.array([[1 - gain, -gain * decay], [0.0, decay]])
    new = share * (1 - decay**2)
    N = np.array([[(1 - gain)**2 * walk**2 + gain**2 * (new + 1 - share), -gain * new], [-gain * new, new]])
    C = np.linalg.solve(np.eye(4) - np.kron(A, A), N.flatten()).reshape(2, 2)
    return C[0, 0], stated


def main():
    print("| random walk of the coordinate, sigmas of the code / root s | " +
          " | ".join(f"errors last {time:g} s" for time in TIMES_S) + " |")
    print("|---" * (1 + len(TIMES_S)) + "|")
    for walk in WALKS:
        cells = []
        for time in TIMES_S:
            decay = np.exp(-1.0 / time)
            best, (is_, _) = with_state(walk, decay, SHARE), inflated(walk, decay, SHARE)
            cells.append(f"{np.sqrt(best / is_):.3f}")
        print(f"| {walk:g} | " + " | ".join(cells) + " |")


if __name__ == "__main__":
    main()
