"""Many texts on many bodies: tasks that can be stopped, resumed, and done anywhere."""
