"""Hands from few markers: which to glue on, and the whole hand from them (Wheatland 2016, ch. 3)."""
