"""From raw streams to averaged force curves: clocks, strokes, rejection, registration."""
