var e=`# Glossary

Terms of buttons, rigs and studies, as the documents use them. The studio's page shows the same entries beside its terms.

## Buttons

- **actuation**: The point of the press where the key closes and the computer gets the keystroke.
- **reset**: The point of the release where the key opens again. Behind it the next keystroke can begin.
- **hysteresis**: The release lags behind the press: it gives back less force at the same place, and resets behind the
  actuation.
- **bump**: The fall of the force after its peak. A finger feels it as a click.
- **peak**: The greatest force before the bump.
- **valley**: The least force behind the peak, before the stop.
- **snap ratio**: Bump divided by peak force. The larger, the crisper the key feels.
- **linear**: The force rises all the way: it never falls by 4 cN.
- **tactile**: The force falls on the press and on the release.
- **clicky**: The force falls at once, or elsewhere on the release. Force alone does not show the sound.
- **travel**: How far the cap moves from contact to the stop.
- **bottom-out**: The stop at the end of the travel, and the force there.
- **preload**: The force at the end of the first step on contact.
- **stroke**: A press, or a release.
- **landmark**: A place or a figure that describes a force curve, such as peak, valley, actuation or travel.
- **JND**: Just noticeable difference: the smallest change that people notice. Distances between buttons are computed in
  JND; they were not tested with people.

## Models

- **FDVV model**: Force over displacement for several velocities, with the vibration of each: what a button feels like.
- **control point**: A point that pulls a curve towards it. Curves are B-splines: a point changes the curve near it only.
- **surface**: Force over displacement and velocity together.
- **program**: A button as states with surfaces, and transitions between them. It can do what no mechanism can.
- **library**: A folder of measured buttons. With the built-in ones and your own it is the catalog.

## Rigs

- **rig**: A machine that renders a button: a voice coil pushes against the finger, sensors measure where it is.
- **twin**: The simulation of a rig and a finger. What it gives is marked *simulated*.
- **target**: The force that a model intends.
- **rendered**: The force that the finger gets.
- **force table**: The commanded forces that make a rig render a model, also called its actuation.
- **compensation**: Learning, from presses, the force table that renders a model in spite of the rig's own mechanics.
- **identification**: Estimating a rig's parameters from presses.
- **feasibility**: What an identified rig can reach of a model, computed before any press.
- **held-out press**: A press that is not used for learning, therefore used for evaluation.
- **force loop**: Control of the force at the finger by a load cell in the cap.
- **telemetry**: What a device reports with every tick.
- **session**: A folder with every press of one piece of work on a rig.

## Studies

- **operator**: Who runs a study.
- **participant**: Who takes part in it.
- **stimulus**: A rendering that a label hides.
- **key holder**: Who can unseal a study, that is, decrypt what its labels hide.
- **design**: One set of parameters that an optimisation tries.
- **trial**: One test of a design.
- **engine**: What suggests the next design.
`,t=/^- \*\*(.+?)\*\*: ((?:.|\n {2})+)/gm;function n(e){let n=e=>e.replace(/\n {2}/g,` `).replace(/\*(\w+)\*/g,`$1`);return new Map([...e.matchAll(t)].map(([,e,t])=>[e,n(t)]))}var r=n(e);export{r as GLOSSARY,n as entriesOf};