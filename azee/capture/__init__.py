"""Hands from few markers: which to glue on, and the whole hand of them (Wheatland 2016, ch. 3)."""
