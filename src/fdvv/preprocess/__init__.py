"""From raw streams to averaged force curves: pure steps, each with declared units."""
