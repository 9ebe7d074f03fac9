"""The command ``stickslip`` where it is not on the path: ``python -m stickslip``."""

from stickslip_command import main

if __name__ == "__main__":
    main()
