"""When the letters of a spelled word are held and passed: models, their fitting and their worth."""
