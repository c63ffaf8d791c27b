def draw_all(x): pass
