/** What the screens of a timing study say, in every language that they know. */

import { printed } from "../../../keyboard/key_names";
import { chosen, filled } from "../words";

const EN = {
  training: "Training {at} of {of}",
  validation: "Trial {at} of {of}",
  code: "Button {code}",
  point: "Press so that the key goes down as the bullet reaches the middle of the zone.",
  tap: "Tap as fast as you can for {time} seconds. The time begins with your first tap.",
  tapNow: "Tap as fast as you can.",
  pressHere: "Press here, or the space bar",
  pressSwitch: "Press {switch}",
  pressTable: "Press the button on the table",
  loading: "One moment …",
  round: "Press {at} of {of}",
  left: "{time} s left",
  pause: "Pause",
  resting: "You paused after {kept} of {of} presses.",
  restingTap: "You paused: the taps of this trial begin anew.",
  goesOn: "{kept} of {of} presses are kept: this trial goes on.",
  placeSwitch: "Put the switch “{switch}” under your finger, then press it once to go on.",
  placeKey: "Put your finger on the key of “{switch}”, then press it once to go on.",
  other: "That key does not count. Please press {key}.",
  space: "the space bar",
  waitTitle: "The first part is done",
  waitText: "Please come back from {date} on, with your card.",
  waitCard: "Your card has the number {person}. Its code brings you back to this place.",
  waitOver: "You can continue now.",
  keys: "Keys: {key} presses, Escape pauses.",
} as const;

export type TimingWord = keyof typeof EN;
type Words = Readonly<Record<TimingWord, string>>;

const DE: Words = {
  training: "Training {at} von {of}",
  validation: "Durchgang {at} von {of}",
  code: "Taste {code}",
  point: "Drücken Sie so, dass die Taste schaltet, wenn der Punkt die Mitte der Zone erreicht.",
  tap: "Tippen Sie {time} Sekunden lang so schnell Sie können. Die Zeit beginnt mit dem ersten Tippen.",
  tapNow: "Tippen Sie so schnell Sie können.",
  pressHere: "Hier drücken, oder die Leertaste",
  pressSwitch: "Drücken Sie {switch}",
  pressTable: "Drücken Sie die Taste auf dem Tisch",
  loading: "Einen Moment …",
  round: "Druck {at} von {of}",
  left: "noch {time} s",
  pause: "Pause",
  resting: "Pause nach {kept} von {of} Drücken.",
  restingTap: "Pause: Das Tippen dieses Durchgangs beginnt von vorn.",
  goesOn: "{kept} von {of} Drücken sind gespeichert: Dieser Durchgang geht weiter.",
  placeSwitch:
    "Legen Sie den Schalter „{switch}“ unter Ihren Finger und drücken Sie ihn einmal, um weiterzumachen.",
  placeKey:
    "Legen Sie den Finger auf die Taste von „{switch}“ und drücken Sie sie einmal, um weiterzumachen.",
  other: "Diese Taste zählt nicht. Bitte drücken Sie {key}.",
  space: "die Leertaste",
  waitTitle: "Der erste Teil ist geschafft",
  waitText: "Bitte kommen Sie ab {date} mit Ihrer Karte wieder.",
  waitCard: "Auf Ihrer Karte steht die Nummer {person}. Mit dem Code kommen Sie hierher zurück.",
  waitOver: "Sie können jetzt weitermachen.",
  keys: "Tasten: {key} drückt, Escape macht Pause.",
};

const FI: Words = {
  training: "Harjoitus {at}/{of}",
  validation: "Osio {at}/{of}",
  code: "Painike {code}",
  point: "Paina niin, että painike kytkeytyy, kun piste on alueen keskellä.",
  tap: "Naputa {time} sekunnin ajan niin nopeasti kuin pystyt. Aika alkaa ensimmäisestä naputuksesta.",
  tapNow: "Naputa niin nopeasti kuin pystyt.",
  pressHere: "Paina tästä tai välilyönnistä",
  pressSwitch: "Paina: {switch}",
  pressTable: "Paina pöydällä olevaa painiketta",
  loading: "Hetkinen …",
  round: "Painallus {at}/{of}",
  left: "{time} s jäljellä",
  pause: "Tauko",
  resting: "Tauko, {kept}/{of} painallusta tehty.",
  restingTap: "Tauko: tämän osion naputus alkaa alusta.",
  goesOn: "{kept}/{of} painallusta on tallessa: tämä osio jatkuu.",
  placeSwitch: "Aseta kytkin ”{switch}” sormesi alle ja jatka painamalla sitä kerran.",
  placeKey: "Aseta sormesi näppäimelle ”{switch}” ja jatka painamalla sitä kerran.",
  other: "Tuo näppäin ei kelpaa. Paina tätä: {key}.",
  space: "välilyönti",
  waitTitle: "Ensimmäinen osa on valmis",
  waitText: "Tule takaisin korttisi kanssa aikaisintaan {date}.",
  waitCard: "Korttisi numero on {person}. Sen koodilla palaat tähän kohtaan.",
  waitOver: "Voit nyt jatkaa.",
  keys: "Näppäimet: {key} painaa, Escape pitää tauon.",
};

const FR: Words = {
  training: "Entraînement {at} sur {of}",
  validation: "Essai {at} sur {of}",
  code: "Bouton {code}",
  point: "Pressez pour que la touche s’enclenche quand le point atteint le milieu de la zone.",
  tap: "Tapez aussi vite que possible pendant {time} secondes. Le temps commence à votre première frappe.",
  tapNow: "Tapez aussi vite que possible.",
  pressHere: "Pressez ici, ou la barre d’espace",
  pressSwitch: "Pressez {switch}",
  pressTable: "Pressez le bouton sur la table",
  loading: "Un instant …",
  round: "Pression {at} sur {of}",
  left: "encore {time} s",
  pause: "Pause",
  resting: "Pause après {kept} pressions sur {of}.",
  restingTap: "Pause : les frappes de cet essai recommencent.",
  goesOn: "{kept} pressions sur {of} sont gardées : cet essai continue.",
  placeSwitch:
    "Placez l’interrupteur « {switch} » sous votre doigt, puis pressez-le une fois pour continuer.",
  placeKey: "Posez le doigt sur la touche de « {switch} », puis pressez-la une fois pour continuer.",
  other: "Cette touche ne compte pas. Veuillez presser {key}.",
  space: "la barre d’espace",
  waitTitle: "La première partie est finie",
  waitText: "Veuillez revenir à partir du {date}, avec votre carte.",
  waitCard: "Votre carte porte le numéro {person}. Son code vous ramène ici.",
  waitOver: "Vous pouvez continuer maintenant.",
  keys: "Touches : {key} presse, Échap met en pause.",
};

const ZH: Words = {
  training: "训练 {at}，共 {of}",
  validation: "第 {at} 题，共 {of} 题",
  code: "按键 {code}",
  point: "请在光点到达区域中央时按下按键。",
  tap: "请在 {time} 秒内尽快连续按压，从第一次按压开始计时。",
  tapNow: "请尽快连续按压。",
  pressHere: "按这里，或按空格键",
  pressSwitch: "请按 {switch}",
  pressTable: "请按桌上的按键",
  loading: "请稍候 …",
  round: "第 {at} 次，共 {of} 次",
  left: "还剩 {time} 秒",
  pause: "暂停",
  resting: "已暂停，完成 {kept} 次，共 {of} 次。",
  restingTap: "已暂停：本题将重新开始按压。",
  goesOn: "已保存 {kept} 次，共 {of} 次：本题继续。",
  placeSwitch: "请把开关“{switch}”放在手指下，然后按一下继续。",
  placeKey: "请把手指放在“{switch}”的按键上，然后按一下继续。",
  other: "这个键不算。请按 {key}。",
  space: "空格键",
  waitTitle: "第一部分已完成",
  waitText: "请从 {date} 起带着您的卡片再来。",
  waitCard: "您的卡片编号是 {person}，凭卡上的代码可回到这里。",
  waitOver: "现在可以继续。",
  keys: "键盘：{key} 按压，Esc 暂停。",
};

const ALL: Readonly<Record<string, Words>> = { en: EN, de: DE, fi: FI, fr: FR, zh: ZH };

/** Return a text in a language, English where it is not known, with its places filled in. */
export function timingWord(
  language: string,
  key: TimingWord,
  places: Readonly<Record<string, string | number>> = {},
): string {
  return filled(chosen(ALL, language, EN)[key], places);
}

/** Name a key for people: `KeyboardEvent.code` as it is printed on it. */
export function keyText(language: string, code: string): string {
  return code === "Space" ? timingWord(language, "space") : printed(code);
}

/** Write a moment for people, in their language and at their place. */
export function dateText(language: string, at: string): string {
  return new Intl.DateTimeFormat(language, { dateStyle: "full", timeStyle: "short" }).format(new Date(at));
}
